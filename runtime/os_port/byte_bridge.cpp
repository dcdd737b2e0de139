// From the port to the bridge, in pieces.
#include "runtime/os_port/byte_bridge.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace ipos::runtime {

PortNeeds ByteBridge::needs() const {
  PortNeeds needs = port_.needs();
  if (!has_room()) needs.descriptor = -1;  // what cannot be taken must not wake the loop
  return needs;
}

bool ByteBridge::gone(const PortError& error) {
  notes_.note(error.text);
  return false;
}

bool ByteBridge::collect(Time epoch) {
  std::array<ByteArrival, 256> bytes;
  while (has_room()) {
    const auto count = port_.receive(bytes);
    if (!count) return gone(count.error());
    if (*count == 0) return true;
    for (ByteArrival& byte : std::span(bytes).first(*count)) {
      byte.at -= epoch;
      arrive(byte);
    }
  }
  notes_.note(fmt::format("{}: {}", port_.name(), crowded()));
  return true;
}

bool ByteBridge::flush() {
  const auto flushed = port_.flush();
  return flushed ? true : gone(flushed.error());
}

std::vector<std::string> ByteBridge::repeats() const {
  std::vector<std::string> all = notes_.repeats();
  for (std::string& text : port_.repeats()) all.push_back(std::move(text));
  return all;
}

std::vector<std::string> ByteBridge::take_notes() {
  std::vector<std::string> all = notes_.take();
  for (std::string& text : port_.take_notes()) all.push_back(fmt::format("{}: {}", port_.name(), text));
  return all;
}

}  // namespace ipos::runtime
