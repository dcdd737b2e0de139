// A plant with the library's hands and ears in it: everything that is made anew when a state is restored.
#pragma once

#include <memory>
#include <vector>

#include "runtime/library/bus_tap.hpp"
#include "runtime/library/deed.hpp"
#include "runtime/plant/hands.hpp"

namespace ipos::library {

class World {
 public:
  explicit World(std::unique_ptr<runtime::Plant> plant);

  // Does it now. Deeds may come from anywhere: one that this plant cannot have seen is refused.
  Refusal perform(const Deed& deed);

  runtime::Plant& plant() { return *plant_; }
  const runtime::Plant& plant() const { return *plant_; }
  std::vector<std::unique_ptr<CanTap>>& can() { return can_; }
  std::vector<std::unique_ptr<SerialTap>>& serial() { return serial_; }

 private:
  Refusal touch(const Deed& deed, Touch touch);
  Refusal send(const Deed& deed);
  Refusal plant_faults(const Deed& deed);

  std::unique_ptr<runtime::Plant> plant_;
  runtime::Hands hands_;
  std::vector<std::unique_ptr<CanTap>> can_;
  std::vector<std::unique_ptr<SerialTap>> serial_;
};

// A frame in a deed, and back; nothing when the bytes are none.
std::vector<uint8_t> frame_bytes(const runtime::Frame& frame);
std::optional<runtime::Frame> frame_of(std::span<const uint8_t> bytes);

}  // namespace ipos::library
