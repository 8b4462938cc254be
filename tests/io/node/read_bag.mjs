// node read_bag.mjs BAG EXPECTED.json FOLDER: exits with 1 and says why when the bag does not hold
// what EXPECTED.json and the raw pictures in FOLDER say.
import { Bag } from "@foxglove/rosbag";
import { FileReader } from "@foxglove/rosbag/node.js";
import lz4 from "@foxglove/wasm-lz4";
import { checkRecording } from "./check_recording.mjs";

const [bagPath, expectedPath, folder] = process.argv.slice(2);
await lz4.isLoaded;
const bag = new Bag(new FileReader(bagPath), {
  decompress: { lz4: (bytes, size) => lz4(bytes, size) },
});
await bag.open();

const messages = {};
for await (const { topic, message, timestamp } of bag.messageIterator()) {
  (messages[topic] ??= []).push({ message, timestamp });
}
console.log(`ok: ${checkRecording(messages, expectedPath, folder)} frames`);
