#include "scripting/scenario/part_schemas.h"

#include <string>

#include "render/streams/image_streams.h"
#include "scripting/scenario/robot_scenario.h"

namespace rubble {

void add_optics_keys(Schema& k, const std::string& at, OpticsSpec& o) {
  k.value(at + "optics.point_spread", o.point_spread,
          "Blur of the whole image: standard deviation of the Gaussian core of the point spread function.")
      .between(0, 20)
      .unit("pixel");
  k.value(at + "optics.glare", o.glare,
          "Veiling glare and bloom: share of the light that the lens scatters.")
      .between(0, 0.5);
  k.value(at + "optics.focus_distance", o.focus_distance,
          "Distance in focus; 0: all distances are sharp.")
      .between(0, 1e4)
      .unit("m");
  k.value(at + "optics.focal_length", o.focal_length,
          "Focal length. The diameter of the aperture is focal_length / `exposure.f_number`. The field of view does "
          "not change.")
      .between(1e-4, 2)
      .unit("m");
  k.value(at + "optics.lateral_colour", o.lateral_colour,
          "Lateral chromatic aberration: distance of red outside blue in the farthest corner.")
      .between(-20, 20)
      .unit("pixel");
  k.value(at + "optics.dirt", o.dirt, "Opacity of smudges on the lens, drawn from the seed; 0: clean.")
      .between(0, 1);
  k.value(at + "optics.drops", o.drops, "Number of rain drops on the lens, drawn from the seed.")
      .between(0, 500);
}

void add_sensor_pattern_keys(Schema& k, const std::string& at, ImageSensorSpec& s) {
  k.value(at + "sensor.pixel_samples", s.pixel_samples,
          "Colour samples of a pixel along each axis, for smooth edges; n x n images are rendered. Depth and "
          "channels are those of the pixel centre.")
      .between(1, 4);
  k.choice(at + "sensor.mosaic", s.mosaic, {"none", "rggb", "bggr", "grbg", "gbrg"},
           "Bayer mosaic of colour filters; the image is demosaiced (Malvar, He and Cutler 2004).");
  k.value(at + "sensor.prnu", s.prnu,
          "Photo response non-uniformity: standard deviation of the gain of the pixels.")
      .between(0, 0.5);
  k.value(at + "sensor.dsnu", s.dsnu,
          "Dark signal non-uniformity: standard deviation of the offset of the pixels, in electrons.")
      .between(0, 1e4);
  k.value(at + "sensor.dark_current", s.dark_current, "Dark current of every pixel.")
      .between(0, 1e7)
      .unit("electron/s");
  k.value(at + "sensor.hot_pixels", s.hot_pixels,
          "Share of hot pixels, drawn from the seed.")
      .between(0, 0.1);
  k.value(at + "sensor.hot_current", s.hot_current,
          "Mean dark current of a hot pixel; exponential distribution.")
      .between(0, 1e8)
      .unit("electron/s");
  k.value(at + "sensor.jpeg_quality", s.jpeg_quality,
          "Artefacts of JPEG compression at this quality, in all outputs; 0: none.")
      .between(0, 100);
}

void check_optics(const CameraScenario& camera, const std::string& at, std::vector<Diagnostic>& mistakes) {
  const OpticsSpec& o = camera.optics;
  const ImageSensorSpec& s = camera.sensor;
  const auto add = [&](const char* key, const char* message, const std::string& expected) {
    mistakes.push_back({"", 0, at + key, message, expected, "", ""});
  };
  if (o.focus_distance > 0 && o.focus_distance <= o.focal_length)
    add("optics.focus_distance", "no lens is sharp within its focal length",
        "more than " + at + "optics.focal_length, or 0");
  if (camera.colour.quality == RenderQuality::reference && s.pixel_samples > 1)
    add("sensor.pixel_samples", "path tracing samples the pixel already", "1");
  if (camera.exposure.mode != ExposureMode::ideal) return;
  const std::string modelled = at + "exposure.mode of \"fixed\" or \"automatic\"";
  if (o.any()) add("optics", "an ideal image has a perfect lens", modelled);
  if (s.mosaic != Mosaic::none || s.has_pattern() || s.jpeg_quality > 0 || s.pixel_samples > 1)
    add("sensor", "an ideal image has no mosaic, fixed pattern, artefacts or pixel_samples", modelled);
}

namespace {

// Every stream that `channels` may name, with what it is.
std::string describe_channels() {
  std::string text = "Ground truth beside colour and depth.";
  for (const ImageStream* stream : truth_streams()) {
    std::string meaning = stream->meaning;
    if (!stream->unit.empty()) meaning.insert(meaning.size() - 1, "; unit: " + stream->unit);
    text += " `\"" + stream->name + "\"`: " + meaning;
  }
  return text;
}

// at: what the keys begin with: "camera.", or nothing.
void add_camera(Schema& k, const std::string& at, CameraScenario& c) {
  k.value(at + "width", c.width, "Width of the image.").between(16, 8192).unit("pixel");
  k.value(at + "height", c.height, "Height of the image.").between(16, 8192).unit("pixel");
  k.value(at + "fov_deg", c.fov_deg,
          "Horizontal field of view, from edge to edge, without the distortion of `plumb_bob`. At most 170, or 360 "
          "with a `fisheye` lens.")
      .between(1, 360)
      .unit("degree");
  k.value(at + "channels", c.channels, describe_channels());
  k.choice(at + "quality", c.colour.quality, {"fast", "reference", "draft"},
           "Computation of colours. `fast`: baked light and shadow maps. `reference`: path tracing, a minute or more "
           "per image (docs/development/reference_renderer.md). `draft`: as `fast`, with hard shadows of the sun and "
           "single scattering in air. Depth and channels are the same.");
  k.value(at + "samples", c.colour.samples, "Quality `reference`: paths per pixel.").between(1, 65536);
  k.value(at + "denoise", c.colour.denoise,
          "Quality `reference`: filters noise by the exact normals, distances and albedos.");
  k.value(at + "stereo_baseline", c.stereo_baseline,
          "Distance to a second camera on the right, with the same lens, exposure and lamp; 0: none.")
      .between(0, 10)
      .unit("m");
  k.value(at + "topic", c.topic,
          "Prefix of the ROS topics; not given: `/camera`, or `/NAME` for one of `cameras`.");
  k.value(at + "frame_id", c.frame_id,
          "TF frame of the pictures (Z forward); not given: `camera_optical_frame`, or `NAME_optical_frame` "
          "for one of `cameras`.");
}

void add_lens(Schema& k, const std::string& at, LensScenario& l) {
  k.choice(at + "lens.model", l.model, {"pinhole", "plumb_bob", "fisheye"},
           "Brown-Conrady (ROS plumb_bob, OpenCV) or Kannala-Brandt (ROS equidistant, OpenCV fisheye).");
  const auto coefficient = [&](const char* name, double& member, const char* doc) {
    k.value(at + "lens." + name, member, doc).between(-100, 100);
  };
  coefficient("k1", l.k1,
              "Radial coefficient of second order; for a fisheye lens, k1 to k4 have OpenCV's order.");
  coefficient("k2", l.k2, "Radial coefficient of fourth order.");
  coefficient("p1", l.p1, "Tangential coefficient, of plumb_bob.");
  coefficient("p2", l.p2, "Tangential coefficient, of plumb_bob.");
  coefficient("k3", l.k3, "Radial coefficient of sixth order.");
  coefficient("k4", l.k4, "Fourth coefficient, of a fisheye lens only.");
  const auto calibrated = [&](const char* name, std::optional<double>& member, const char* doc) {
    return &k.value(at + "lens." + name, member, doc).unit("pixel");
  };
  calibrated("fx", l.fx, "Focal length of a calibrated camera, instead of `fov_deg`.")->above(0, 1e6);
  calibrated("fy", l.fy, "Vertical focal length; not given: as fx.")->above(0, 1e6);
  calibrated("cx", l.cx, "Column of the principal point; not given: the centre.")->between(-1e5, 1e5);
  calibrated("cy", l.cy, "Row of the principal point; not given: the centre.")->between(-1e5, 1e5);
}

void add_shutter(Schema& k, const std::string& at, ShutterSpec& s) {
  k.value(at + "shutter.readout", s.readout,
          "Rolling shutter: time from the first row to the last; 0: a global shutter.")
      .between(0, 1)
      .unit("s");
  k.value(at + "shutter.motion_blur", s.motion_blur,
          "Averages images over the exposure, in linear light: one for each pixel of motion.");
  k.value(at + "shutter.most_samples", s.most_samples, "Largest number of images for `motion_blur`.").between(3, 255);
}

void add_exposure(Schema& k, const std::string& at, ExposureSpec& e) {
  k.choice(at + "exposure.mode", e.mode, {"ideal", "fixed", "automatic"},
           "`ideal`: a display image without noise, metered on the frame itself; the other keys have no effect. "
           "`fixed`, `automatic`: a modelled exposure.");
  k.value(at + "exposure.time", e.time, "Exposure time t.").between(1e-6, 1).unit("s");
  k.value(at + "exposure.iso", e.iso, "ISO speed S. Automatic: the lowest one.").between(1, 1e6);
  k.value(at + "exposure.f_number", e.f_number, "F-number N of the aperture.").between(0.5, 64);
  k.value(at + "exposure.compensation", e.compensation,
          "Automatic: exposure compensation, relative to a mean of 18 %.")
      .between(-8, 8)
      .unit("stop");
  k.value(at + "exposure.longest_time", e.longest_time,
          "Automatic: longest exposure time. It is raised before the ISO speed.")
      .between(1e-6, 1)
      .unit("s");
  k.value(at + "exposure.highest_iso", e.highest_iso, "Automatic: highest ISO speed.").between(1, 1e6);
  k.value(at + "exposure.time_constant", e.time_constant,
          "Automatic: time in which the error falls by a factor of e; 0: at once.")
      .between(0, 60)
      .unit("s");
  k.value(at + "exposure.delay", e.delay, "Automatic: number of frames until a metered value takes effect.")
      .between(0, 16);
}

void add_sensor(Schema& k, const std::string& at, ImageSensorSpec& s) {
  k.value(at + "sensor.noise", s.noise, "Shot and read noise.");
  k.value(at + "sensor.full_well", s.full_well, "Electrons at saturation at ISO 100.")
      .between(10, 1e7);
  k.value(at + "sensor.read_noise", s.read_noise, "Standard deviation of the read noise, in electrons.")
      .between(0, 1000);
  k.value(at + "sensor.bits", s.bits, "Resolution of the analogue-digital converter.").between(1, 16);
  k.value(at + "sensor.vignette", s.vignette,
          "Strength of vignetting; 0: none; 1: the natural cos^4 fall-off.")
      .between(0, 4);
  k.choice(at + "sensor.response", s.response, {"srgb", "gamma", "linear"},
           "Response curve from the converter to the stored 8 bits.");
  k.value(at + "sensor.gamma", s.gamma, "Exponent 1 / gamma of the response `gamma`.")
      .between(0.2, 5);
  add_sensor_pattern_keys(k, at, s);
}

void add_depth_sensor(Schema& k, DepthSensorSpec& d) {
  k.group("depth_sensor",
          "A depth sensor in the place of the camera. Its measurement is recorded beside the exact depth, and it "
          "sees the same smoke and dust. Thin fog disturbs a time-of-flight sensor, because the emitter lights the "
          "fog in front of the lens. Example: a wall 3 m away and a lens of 60 degrees. In fog of 0.01, 0.03 and 0.1 "
          "/m, 62, 19 and 5 % of the pixels are within 10 cm; with an emitter_offset of 0.3 m, 100, 100 and 48 %. "
          "Other types report the fog, or no return if the fog is nearer than min_range.");
  k.choice("depth_sensor.type", d.type, {"none", "ideal", "structured_light", "time_of_flight"},
           "Type of sensor.");
  k.value("depth_sensor.min_range", d.min_range, "Shorter distances give no return.").between(0, 100).unit("m");
  k.value("depth_sensor.max_range", d.max_range, "Longer distances give no return.").above(0, 1000).unit("m");
  k.value("depth_sensor.noise", d.noise, "Adds noise to the measurement.");
  k.value("depth_sensor.baseline", d.baseline, "Structured light: distance from camera to projector.")
      .above(0, 10)
      .unit("m");
  k.value("depth_sensor.disparity_step", d.disparity_step,
          "Structured light: resolution of the disparity, in pixels of an image 640 pixels wide.")
      .above(0, 10)
      .unit("pixel");
  k.value("depth_sensor.disparity_noise", d.disparity_noise,
          "Structured light: standard deviation of the disparity, including its resolution.")
      .between(0, 10)
      .unit("pixel");
  k.value("depth_sensor.modulation_mhz", d.modulation_mhz,
          "Time of flight: modulation frequency f; ranges wrap at c / 2f, 7.5 m at 20 MHz.")
      .between(1, 1000)
      .unit("MHz");
  k.value("depth_sensor.signal", d.signal,
          "Time of flight: electrons from a white surface at 1 m, at normal incidence.")
      .above(0, 1e9);
  k.value("depth_sensor.background", d.background, "Time of flight: electrons from ambient light.")
      .between(0, 1e9);
  k.value("depth_sensor.emitter_offset", d.emitter_offset,
          "Time of flight: distance from the lens to the emitter on its right. A larger distance lights less air in "
          "front of the lens.")
      .between(0.001, 1)
      .unit("m");
  k.value("depth_sensor.reflectance", d.reflectance,
          "Infrared reflectance of all surfaces; 0: that of the look of each surface.")
      .between(0, 1);
  k.value("depth_sensor.least_amplitude", d.least_amplitude,
          "Time of flight: fewer electrons give no return.")
      .between(0, 1e9);
  k.value("depth_sensor.step", d.step, "Time of flight: resolution of the depth, which is planar; 0: not rounded.")
      .between(0, 1)
      .unit("m");
}

void add_event_camera(Schema& k, EventCameraSpec& e) {
  k.group("event_camera", "An event camera in the place of the camera, with the same lens (ESIM).");
  k.value("event_camera.on", e.on, "Switches the event camera on.");
  k.value("event_camera.threshold_up", e.threshold_up,
          "Rise of ln(luminance) that triggers an event.")
      .between(0.01, 10);
  k.value("event_camera.threshold_down", e.threshold_down, "Fall of ln(luminance) that triggers an event.")
      .between(0.01, 10);
  k.value("event_camera.threshold_noise", e.threshold_noise,
          "Standard deviation of the thresholds between pixels.")
      .between(0, 1);
  k.value("event_camera.refractory", e.refractory, "A pixel triggers no event for this time after an event.")
      .between(0, 1)
      .unit("s");
  k.value("event_camera.background_hz", e.background_hz, "Rate of noise events of each pixel.")
      .between(0, 1000)
      .unit("Hz");
  k.value("event_camera.most_motion", e.most_motion,
          "Largest motion between two rendered images, of which there are at most 1000 from one frame to the next. A smaller value "
          "gives more exact times and takes longer.")
      .between(0.05, 100)
      .unit("pixel");
  k.value("event_camera.dark", e.dark, "Luminance added before the logarithm.")
      .above(0, 1e6)
      .unit("cd/m2");
}

void add_camera_with(Schema& k, const std::string& at, CameraScenario& c) {
  add_camera(k, at, c);
  const auto group = [&](const char* name, const char* doc) { k.group(at + name, doc); };
  group("lens", "The lens. Depth and channels are exact for the ray of each pixel. Depth is planar: NaN where a ray goes sideways or back, more than 90 degrees off the axis.");
  add_lens(k, at, c.lens);
  group("shutter", "The stamp of a frame is the middle of its exposure.");
  add_shutter(k, at, c.shutter);
  group("exposure",
        "Exposure of the image. The share of saturation is 0.65 L t S / (78 N^2) for a luminance L in cd/m2 (ISO "
        "12232:2006).");
  add_exposure(k, at, c.exposure);
  group("optics",
        "Aberrations of a real lens. They change the colour image only, and need `exposure.mode` `fixed` or "
        "`automatic` (docs/explanation/optics.md).");
  add_optics_keys(k, at, c.optics);
  group("sensor", "Image sensor (EMVA 1288). No effect on an ideal exposure.");
  add_sensor(k, at, c.sensor);
}

Schema mounted_camera_schema(MountedCamera& m) {
  Schema k;
  add_ride_keys(k, "", m.ride);
  k.value("position", m.position, "Position of the camera body on the rig, or on the link of `ride`: X forward, Y "
                                  "left, Z up.")
      .between(-10, 10)
      .unit("m");
  k.value("rpy_deg", m.rpy_deg, "Roll, pitch (positive: down) and yaw (positive: left) in the same frame.")
      .between(-360, 360)
      .unit("degree");
  k.value("rate_hz", m.rate_hz, "Frames per second; not given: `trajectory.rate_hz`.")
      .between(0.001, 1000)
      .unit("Hz");
  add_camera_with(k, "", m.camera);
  add_depth_sensor(k, m.depth_sensor);
  add_event_camera(k, m.event_camera);
  return k;
}

}  // namespace

void add_camera_keys(Schema& keys, MissionForm& form) {
  keys.group("camera",
          "The camera. Colour and depth have the same pixels. The default is an exact pinhole camera.");
  add_camera_with(keys, "camera.", form.camera.camera);
  keys.add("cameras",
           "Several cameras instead of `camera`: `cameras = { front = { ... }, left = { ... } }`. Names have "
           "lower-case letters, digits and underscores. A camera is fixed to the rig, which flies the trajectory and "
           "has the lamp, or to a link of a robot (`ride`), with a lamp of its own. Each camera has the keys below, "
           "every key of `camera`, and its own `depth_sensor` and `event_camera`.",
           [&form](std::size_t) {
             return Schema::named_tables(form.rest.cameras, &MountedCamera::name, "front",
                                         mounted_camera_schema);
           });
  add_depth_sensor(keys, form.camera.depth_sensor);
  add_event_camera(keys, form.camera.event_camera);
}

}  // namespace rubble
