// node read_robots.mjs MCAP: what a recording says of its robot, as JSON. Reads by the index, with every
// checksum, each message by the schema in the file.
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
const triple = ({ x, y, z }) => [x, y, z];
const odometry = (m) => ({
  frame: m.header.frame_id,
  child: m.child_frame_id,
  position: triple(m.pose.pose.position),
  linear: triple(m.twist.twist.linear),
  angular: triple(m.twist.twist.angular),
});
const read = { joints: [], odom: [], truth: [], contacts: [], description: [], parents: {} };
const take = {
  "/joint_states": (m) =>
    read.joints.push({
      name: m.name,
      position: Array.from(m.position),
      velocity: Array.from(m.velocity),
      effort: Array.from(m.effort),
    }),
  "/odom": (m) => read.odom.push(odometry(m)),
  "/ground_truth/odom": (m) => read.truth.push(odometry(m)),
  "/contacts": (m) =>
    read.contacts.push({
      frame: m.header.frame_id,
      force: triple(m.wrench.force),
      torque: triple(m.wrench.torque),
    }),
  "/robot_description": (m) => read.description.push(m.data),
  "/tf": (m) => addTransforms(m),
  "/tf_static": (m) => addTransforms(m),
};
function addTransforms(m) {
  for (const t of m.transforms) {
    read.parents[t.child_frame_id] ??= t.header.frame_id;
    assert.equal(read.parents[t.child_frame_id], t.header.frame_id, `${t.child_frame_id} has two parents`);
  }
}
const readers = new Map();
for await (const { channelId, data } of reader.readMessages({ validateCrcs: true })) {
  const channel = reader.channelsById.get(channelId);
  if (!readers.has(channelId)) {
    const text = new TextDecoder().decode(reader.schemasById.get(channel.schemaId).data);
    readers.set(channelId, new MessageReader(parse(text, { ros2: true })));
  }
  take[channel.topic]?.(readers.get(channelId).readMessage(data));
}
console.log(JSON.stringify(read));
