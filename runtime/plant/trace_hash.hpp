// `ipos run --trace-hash`: one number over everything a run did, to compare runs, builds and engines. Two
// runs with the same number had, in every millisecond, the same variables, tasks, drives and outputs, and the
// same frames and characters at the same times.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "runtime/plant/plant.hpp"

namespace ipos::runtime {

// FNV-1a, 64 bits, over numbers of 64 bits instead of bytes.
class TraceHash final : private BusTracer {
 public:
  // Watches the buses of the plant, which must outlive it.
  explicit TraceHash(Plant& plant);

  // For Plant::run_until: takes the state at whole milliseconds, after all that happened at that time.
  void sample(Time now);

  uint64_t value() const { return hash_; }
  std::string text() const;  // 16 hexadecimal digits

 private:
  friend uint64_t state_digest(const Plant& plant);

  TraceHash() = default;  // that watches nothing
  void on_trace(const Bus& bus, std::span<const uint64_t> facts) override;

  void add(uint64_t value) { hash_ = (hash_ ^ value) * 0x100000001B3; }
  void add_text(const std::string& text);
  void add_state(Time now, const Plant& plant);
  void add_station(const Station& station);
  template <typename... Values>
  void add_all(Values... values) {
    (add(static_cast<uint64_t>(values)), ...);
  }

  const Plant* plant_ = nullptr;
  uint64_t hash_ = 0xCBF29CE484222325;
};

// One number over the present state alone.
uint64_t state_digest(const Plant& plant);

}  // namespace ipos::runtime
