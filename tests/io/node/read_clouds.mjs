// node read_clouds.mjs MCAP: prints as JSON the layout of every cloud and scan of a LiDAR and a hash of its
// data, as tests/app/read_lidar.py does of a bag. Reads by the index, with every checksum.
import { createHash } from "node:crypto";
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
const sha1 = (...parts) => parts.reduce((hash, part) => hash.update(part), createHash("sha1")).digest("hex");
const bytesOf = (floats) => Buffer.from(Float32Array.from(floats).buffer);
const readers = new Map(), result = {};
for await (const { channelId, data } of reader.readMessages({ validateCrcs: true })) {
  const channel = reader.channelsById.get(channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  if (!readers.has(channelId)) {
    const text = new TextDecoder().decode(schema.data);
    readers.set(channelId, new MessageReader(parse(text, { ros2: true })));
  }
  const m = readers.get(channelId).readMessage(data);
  let entry;
  if (schema.name === "sensor_msgs/msg/PointCloud2")
    entry = { size: [m.height, m.width, m.point_step], data: sha1(m.data),
              fields: m.fields.map((f) => [f.name, f.offset, f.datatype, f.count]) };
  else if (schema.name === "sensor_msgs/msg/LaserScan")
    entry = { size: m.ranges.length, angles: [m.angle_min, m.angle_max, m.angle_increment],
              data: sha1(bytesOf(m.ranges), bytesOf(m.intensities)) };
  else continue;
  (result[channel.topic] ??= []).push({ ...entry, frame: m.header.frame_id });
}
console.log(JSON.stringify(result));
