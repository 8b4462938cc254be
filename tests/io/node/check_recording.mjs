// Compares the messages of a recording, from whichever file they were read, with expected.json and
// the raw pictures beside it. `messages`: topic to a list of { message, timestamp }.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";

// ROS 2 names nanoseconds and the calibration's matrices differently.
function stampOf({ sec, nsec, nanosec }) {
  return { sec, nsec: nsec ?? nanosec };
}

export function checkRecording(messages, expectedPath, folder) {
  const expected = JSON.parse(fs.readFileSync(expectedPath, "utf8"));
  const frames = expected.frames;
  const topics = new Set(Object.keys(messages));
  const take = (topic, count) => {
    assert.equal(messages[topic]?.length, count, `messages on ${topic}`);
    topics.delete(topic);
    return messages[topic];
  };
  const floats = (values) => Array.from(values);

  function takeStamped(topic) {
    const list = take(topic, frames.length);
    list.forEach(({ message, timestamp }, i) => {
      assert.deepEqual(stampOf(timestamp), frames[i].stamp, `${topic}: time in the file`);
      assert.deepEqual(stampOf(message.header.stamp), frames[i].stamp, `${topic}: stamp`);
      if (!expected.ros2) assert.equal(message.header.seq, i, `${topic}: seq`);
    });
    return list;
  }

  function checkImage(topic, encoding, bytesPerPixel, suffix, frame = "camera_optical_frame") {
    takeStamped(topic).forEach(({ message }, i) => {
      assert.equal(message.encoding, encoding);
      assert.equal(message.width, expected.width);
      assert.equal(message.height, expected.height);
      assert.equal(message.step, expected.width * bytesPerPixel);
      assert.equal(message.is_bigendian, 0);
      assert.equal(message.header.frame_id, frame);
      const pixels = fs.readFileSync(path.join(folder, `${i}.${suffix}`));
      assert.equal(Buffer.compare(Buffer.from(message.data), pixels), 0, `${topic}: frame ${i}`);
    });
  }

  function checkInfo(topic, shift = 0) {
    for (const { message } of takeStamped(topic)) {
      assert.deepEqual(floats(message.K ?? message.k), expected.K);
      assert.equal((message.P ?? message.p)[3], shift, `${topic}: P[3]`);
      assert.equal(message.distortion_model, "plumb_bob");
      assert.deepEqual(floats(message.D ?? message.d), expected.D);
    }
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
  checkInfo("/camera/rgb/camera_info");
  checkInfo("/camera/depth_registered/camera_info");

  const poses = takeStamped("/ground_truth/pose");
  const transforms = take("/tf", frames.length);
  checkClock();
  frames.forEach((frame, i) => {
    const { pose, header } = poses[i].message;
    assert.equal(header.frame_id, "world");
    checkPose(pose.position, pose.orientation, frame);
    const [transform] = transforms[i].message.transforms;
    assert.equal(transform.header.frame_id, "world");
    assert.equal(transform.child_frame_id, "camera_link");
    checkPose(transform.transform.translation, transform.transform.rotation, frame);
  });
  const fixed = take("/tf_static", 1)[0].message.transforms;
  assert.equal(fixed.length, expected.channels ? 2 : 1);
  assert.equal(fixed[0].header.frame_id, "camera_link");
  assert.equal(fixed[0].child_frame_id, "camera_optical_frame");
  const { translation, rotation } = fixed[0].transform;
  checkPose(translation, rotation, { translation: [0, 0, 0], rotation: [0.5, -0.5, 0.5, -0.5] });

  if (expected.channels) checkChannels();
  assert.deepEqual([...topics], [], "topics that were not expected");
  return frames.length;

  // It has every stamp of every stream, once and in order.
  function checkClock() {
    const nanoseconds = (time) => BigInt(time.sec) * 1000000000n + BigInt(stampOf(time).nsec);
    const all = Object.values(messages).flat().map(({ timestamp }) => nanoseconds(timestamp));
    const ticks = messages["/clock"].map(({ message }) => nanoseconds(message.clock));
    assert.deepEqual(ticks, [...new Set(all)].sort((a, b) => (a < b ? -1 : 1)), "/clock");
    topics.delete("/clock");
  }

  function checkChannels() {
    checkImage("/camera/right/image_raw", "rgb8", 3, "right", "camera_right_optical_frame");
    checkInfo("/camera/right/camera_info", -expected.K[0] * expected.baseline);
    checkInfo("/ground_truth/depth/camera_info");
    checkImage("/ground_truth/depth/image", "32FC1", 4, "true_depth");
    checkImage("/ground_truth/normals/image", "32FC3", 12, "normals");
    checkImage("/ground_truth/flow/image", "32FC2", 8, "flow");
    checkImage("/ground_truth/sky_visibility/image", "32FC1", 4, "sky");
    checkImage("/ground_truth/instance/image", "32SC1", 4, "instance");
    checkImage("/ground_truth/label/image", "16UC1", 2, "label");
    const legend = JSON.parse(take("/ground_truth/legend", 1)[0].message.data);
    assert.deepEqual(legend.labels[2], { label: 2, name: "brick" });
    assert.deepEqual(legend.instances[1], { instance: 1, label: 3, name: "slab \"7\"" });
    const right = fixed[1];
    assert.equal(right.child_frame_id, "camera_right_optical_frame");
    const { x, y, z } = right.transform.translation;
    assert.deepEqual([x, y, z], [0, -expected.baseline, 0]);

    takeStamped("/camera/events").forEach(({ message }, i) => {
      const events = message.events.map((e) => [e.x, e.y, stampOf(e.ts), e.polarity]);
      const wanted = frames[i].events.map(([x, y, ts, p]) => [x, y, ts, p]);
      assert.deepEqual(events, wanted, `events of frame ${i}`);
    });
    const imu = frames.flatMap((frame) => frame.imu);
    take("/imu", imu.length).forEach(({ message, timestamp }, i) => {
      assert.deepEqual(stampOf(timestamp), imu[i].stamp);
      assert.deepEqual(stampOf(message.header.stamp), imu[i].stamp);
      assert.equal(message.header.frame_id, "camera_link");
      assert.equal(message.orientation_covariance[0], -1);
      const { angular_velocity: w, linear_acceleration: a } = message;
      assert.deepEqual([w.x, w.y, w.z], imu[i].angular_velocity);
      assert.deepEqual([a.x, a.y, a.z], imu[i].linear_acceleration);
      assert.ok(Math.abs(message.angular_velocity_covariance[4] - expected.gyroscope_variance) < 1e-18);
    });
  }
}
