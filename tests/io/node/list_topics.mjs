// node list_topics.mjs MCAP: prints as JSON the stamps and the frame of every topic whose messages have a
// header, and the transforms of /tf_static as child: parent. Reads by the index, with every checksum.
import assert from "node:assert/strict";
import fs from "node:fs";
import { McapIndexedReader } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";

const bytes = fs.readFileSync(process.argv[2]);
const reader = await McapIndexedReader.Initialize({
  readable: {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
  },
  decompressHandlers: await loadDecompressHandlers(),
});
const readers = new Map(), headers = {}, fixed = {};
for await (const { channelId, data } of reader.readMessages({ validateCrcs: true })) {
  const channel = reader.channelsById.get(channelId);
  if (!readers.has(channelId)) {
    const text = new TextDecoder().decode(reader.schemasById.get(channel.schemaId).data);
    readers.set(channelId, new MessageReader(parse(text, { ros2: true })));
  }
  const message = readers.get(channelId).readMessage(data);
  if (channel.topic === "/tf_static")
    for (const t of message.transforms) fixed[t.child_frame_id] = t.header.frame_id;
  if (!message.header) continue;
  const entry = (headers[channel.topic] ??= { frame: message.header.frame_id, stamps: [] });
  assert.equal(message.header.frame_id, entry.frame);
  const { sec, nsec, nanosec } = message.header.stamp;
  entry.stamps.push(sec * 1e9 + (nanosec ?? nsec));
}
console.log(JSON.stringify({ headers, fixed }));
