// node read_mcap.mjs MCAP EXPECTED.json FOLDER: exits with 1 and says why when the file is not
// whole, a checksum is wrong, or it does not hold what EXPECTED.json and the pictures in FOLDER say.
// The file is read twice: from end to end as a stream, and by its index.
import assert from "node:assert/strict";
import fs from "node:fs";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { checkRecording } from "./check_recording.mjs";

const [mcapPath, expectedPath, folder] = process.argv.slice(2);
const bytes = fs.readFileSync(mcapPath);
const decompressHandlers = await loadDecompressHandlers();

function timeOf(nanoseconds) {
  return { sec: Number(nanoseconds / 1000000000n), nsec: Number(nanoseconds % 1000000000n) };
}

class Collector {
  readers = new Map();
  messages = {};
  sequences = new Map();

  add(channel, schema, { channelId, sequence, logTime, publishTime, data }) {
    assert.equal(schema.encoding, "ros2msg");
    assert.equal(channel.messageEncoding, "cdr");
    if (!this.readers.has(channelId)) {
      const text = new TextDecoder().decode(schema.data);
      this.readers.set(channelId, new MessageReader(parse(text, { ros2: true })));
    }
    assert.equal(sequence, this.sequences.get(channelId) ?? 0, `sequence on ${channel.topic}`);
    this.sequences.set(channelId, sequence + 1);
    assert.equal(logTime, publishTime);
    const message = this.readers.get(channelId).readMessage(data);
    (this.messages[channel.topic] ??= []).push({ message, timestamp: timeOf(logTime), schema });
  }
}

const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(bytes);
const channels = new Map(), schemas = new Map(), streamed = new Collector();
const opcodes = new Map();
for (let record; (record = stream.nextRecord()); ) {
  opcodes.set(record.type, (opcodes.get(record.type) ?? 0) + 1);
  if (record.type === "Header") assert.equal(record.profile, "ros2");
  if (record.type === "DataEnd") assert.notEqual(record.dataSectionCrc, 0);
  if (record.type === "Footer") assert.notEqual(record.summaryCrc, 0);
  if (record.type === "Schema") schemas.set(record.id, record);
  if (record.type === "Channel") channels.set(record.id, record);
  if (record.type === "Message") {
    const channel = channels.get(record.channelId);
    streamed.add(channel, schemas.get(channel.schemaId), record);
  }
}
assert.ok(stream.done(), "the stream ended early");
assert.equal(stream.bytesRemaining(), 0);

const reader = await McapIndexedReader.Initialize({
  readable: {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
  },
  decompressHandlers,
});
const indexed = new Collector();
for await (const message of reader.readMessages({ validateCrcs: true })) {
  const channel = reader.channelsById.get(message.channelId);
  indexed.add(channel, reader.schemasById.get(channel.schemaId), message);
}
const count = Object.values(indexed.messages).reduce((sum, list) => sum + list.length, 0);
assert.equal(Number(reader.statistics.messageCount), count);
assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
for (const [id, n] of reader.statistics.channelMessageCounts) {
  assert.equal(Number(n), indexed.messages[reader.channelsById.get(id).topic]?.length ?? 0);
}
assert.deepEqual([...reader.summaryOffsetsByOpcode.keys()].sort((a, b) => a - b), [3, 4, 8, 11]);
const fixed = [...reader.channelsById.values()].find((c) => c.topic === "/tf_static");
assert.match(fixed.metadata.get("offered_qos_profiles"), /durability: 1/);

checkRecording(streamed.messages, expectedPath, folder);
console.log(`ok: ${checkRecording(indexed.messages, expectedPath, folder)} frames`);
