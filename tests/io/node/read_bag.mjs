// node read_bag.mjs BAG EXPECTED.json FOLDER: exits with 1 and says why when the bag does not hold
// what EXPECTED.json and the raw pictures in FOLDER say.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { Bag } from "@foxglove/rosbag";
import { FileReader } from "@foxglove/rosbag/node.js";
import lz4 from "@foxglove/wasm-lz4";

const [bagPath, expectedPath, folder] = process.argv.slice(2);
const expected = JSON.parse(fs.readFileSync(expectedPath, "utf8"));

await lz4.isLoaded;
const bag = new Bag(new FileReader(bagPath), {
  decompress: { lz4: (bytes, size) => lz4(bytes, size) },
});
await bag.open();

const messages = {};
for await (const { topic, message, timestamp } of bag.messageIterator()) {
  (messages[topic] ??= []).push({ message, timestamp });
}

function stampOf({ sec, nsec }) {
  return { sec, nsec };
}

function checkStamps(topic) {
  assert.equal(messages[topic]?.length, expected.frames.length, `messages on ${topic}`);
  messages[topic].forEach(({ message, timestamp }, i) => {
    const stamp = expected.frames[i].stamp;
    assert.deepEqual(stampOf(timestamp), stamp, `${topic}: time in the bag`);
    assert.deepEqual(stampOf(message.header.stamp), stamp, `${topic}: stamp`);
    assert.equal(message.header.seq, i, `${topic}: seq`);
  });
}

function checkImage(topic, encoding, bytesPerPixel, suffix) {
  checkStamps(topic);
  messages[topic].forEach(({ message }, i) => {
    assert.equal(message.encoding, encoding);
    assert.equal(message.width, expected.width);
    assert.equal(message.height, expected.height);
    assert.equal(message.step, expected.width * bytesPerPixel);
    assert.equal(message.is_bigendian, 0);
    assert.equal(message.header.frame_id, "camera_optical_frame");
    const pixels = fs.readFileSync(path.join(folder, `${i}.${suffix}`));
    assert.equal(Buffer.compare(Buffer.from(message.data), pixels), 0, `${topic}: frame ${i}`);
  });
}

function checkPose({ x, y, z }, rotation, pose) {
  assert.deepEqual([x, y, z], pose.translation);
  assert.deepEqual([rotation.w, rotation.x, rotation.y, rotation.z], pose.rotation);
}

checkImage("/camera/rgb/image_raw", "rgb8", 3, "rgb");
if (expected.depth === "16UC1") {
  checkImage("/camera/depth_registered/image_raw", "16UC1", 2, "depth");
} else {
  checkImage("/camera/depth_registered/image", "32FC1", 4, "depth");
}
for (const camera of ["rgb", "depth_registered"]) {
  checkStamps(`/camera/${camera}/camera_info`);
  for (const { message } of messages[`/camera/${camera}/camera_info`]) {
    assert.deepEqual(Array.from(message.K), expected.K);
    assert.equal(message.distortion_model, "plumb_bob");
    assert.equal(message.D.length, 5);
  }
}
checkStamps("/ground_truth/pose");
expected.frames.forEach((frame, i) => {
  const { pose, header } = messages["/ground_truth/pose"][i].message;
  assert.equal(header.frame_id, "world");
  checkPose(pose.position, pose.orientation, frame);
  const [transform] = messages["/tf"][i].message.transforms;
  assert.equal(transform.header.frame_id, "world");
  assert.equal(transform.child_frame_id, "camera_link");
  checkPose(transform.transform.translation, transform.transform.rotation, frame);
  assert.deepEqual(stampOf(messages["/clock"][i].message.clock), frame.stamp);
});
assert.equal(messages["/tf_static"].length, 1);
const [fixed] = messages["/tf_static"][0].message.transforms;
assert.equal(fixed.header.frame_id, "camera_link");
assert.equal(fixed.child_frame_id, "camera_optical_frame");
checkPose(fixed.transform.translation, fixed.transform.rotation, {
  translation: [0, 0, 0],
  rotation: [0.5, -0.5, 0.5, -0.5],
});
console.log(`ok: ${expected.frames.length} frames`);
