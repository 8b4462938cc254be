#include "app/support/drawing_device.h"

#include <charconv>
#include <cstdlib>

#include "kernel/base/error.h"

namespace rubble {

std::optional<AskedDevice> read_device(const std::string& text) {
  if (text == device_names()[0]) return AskedDevice{};
  const std::string& card = device_names()[1];
  AskedDevice out{DeviceKind::gl, -1};
  if (text == card) return out;
  if (text.compare(0, card.size() + 1, card + ":") != 0) return std::nullopt;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + card.size() + 1, end, out.card);
  if (read.ec != std::errc() || read.ptr != end || out.card < 0) return std::nullopt;
  return out;
}

std::string describe_devices() { return "software, gl, or gl:N with the number of a card in `rubble info --gl`"; }

std::optional<AskedDevice> asked_device(const std::string& option) {
  if (!option.empty()) return read_device(option);
  const char* const text = std::getenv("RUBBLE_DEVICE");
  const std::string found = text ? text : "";
  if (found.empty()) return std::nullopt;
  if (const auto asked = read_device(found)) return asked;
  throw InputError({"", 0, "RUBBLE_DEVICE", "is no device", describe_devices(), found, "set it to one of them, or unset it"});
}

std::unique_ptr<Device> open_device(const std::string& option, int threads) {
  const AskedDevice asked = asked_device(option).value_or(AskedDevice{});
  return make_device({asked.kind, asked.card, threads});
}

std::unique_ptr<Device> open_device(DeviceKind kind, const std::string& option, int threads) {
  const std::optional<AskedDevice> asked = asked_device(option);
  const std::string& name = device_names()[std::size_t(kind)];
  if (!option.empty() && asked->kind != kind)
    throw InputError({"", 0, "--device", "is not the device that drew this run, as its manifest says", name, option,
                      kind == DeviceKind::gl ? "leave it out, or choose a card by gl:N" : "leave it out"});
  try {
    return make_device({kind, asked && asked->kind == kind ? asked->card : -1, threads});
  } catch (const RunError& error) {
    throw RunError(std::string(error.what()) + "\nthe device " + name +
                   " draws because --device, RUBBLE_DEVICE, the key `device` of the mission or the manifest of the run says so");
  }
}

}  // namespace rubble
