// `ipos run --trace-hash`: one number over what a run did, to compare runs, builds and engines. Two runs with the
// same number had the same frames and characters at the same times; their drives had, in every millisecond, the same
// status, fault, speed, setpoint, inputs and outputs; and every tenth of a second, and at the end, everything was the
// same: variables, tasks, positions, temperatures. What foreign machines gave to their signals was the same, too.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/plant/plant.hpp"

namespace ipos::runtime {

// FNV-1a, 64 bits, over numbers of 64 bits instead of bytes.
class NumberHash {
 public:
  void add(uint64_t value) { hash_ = (hash_ ^ value) * kPrime; }
  template <typename... Values>
  void add_all(Values... values) {
    (add(static_cast<uint64_t>(values)), ...);
  }
  void add_text(const std::string& text);
  void add_many(std::span<const int32_t> values);
  uint64_t value() const { return hash_; }

 private:
  static constexpr uint64_t kPrime = 0x100000001B3;
  uint64_t hash_ = 0xCBF29CE484222325;
};

class TraceHash final : private BusTracer, private MachineWatcher {
 public:
  // Everything is looked at so often: tasks that run ahead would have to stop for each look (ours).
  static constexpr Time kStep = 100 * kMillisecond;

  // Watches buses and drives of the plant, which must outlive it. `step`: whole milliseconds.
  explicit TraceHash(Plant& plant, Time step = kStep);

  // For Plant::run_until: takes the state at whole milliseconds, after all that happened at that time.
  void sample(Time now);

  uint64_t value() const;
  std::string text() const;  // 16 hexadecimal digits

 private:
  // What a drive decides, each change with its time.
  class Course final : public DriveWatcher {
   public:
    explicit Course(const Station& station) : station_(station) {}
    void sample(Time now);
    uint64_t value() const { return hash_.value(); }

   private:
    using Values = std::array<uint64_t, 3>;
    void on_decided(const Drive& drive, Time tick) override { note(drive, tick, true); }
    void note(const Drive& drive, Time now, bool powered);

    const Station& station_;
    Values last_{};
    NumberHash hash_;
  };

  void on_trace(const Bus& bus, std::span<const uint64_t> facts) override;
  void on_given(size_t machine, Time now, std::span<const int64_t> samples) override;

  // What was heard on the lines of an island, until all islands have come so far.
  struct Heard {
    EventQueue::Moment moment;
    size_t begin, end;  // in facts
  };
  struct OfIsland {
    std::vector<Heard> heard{};
    std::vector<uint64_t> facts{};
  };
  struct Named {
    const Bus* bus;
    uint64_t name;  // as one number
    size_t island;
  };
  void add_heard(NumberHash& hash) const;

  const Plant& plant_;
  Time step_;
  std::vector<std::unique_ptr<Course>> courses_;
  std::vector<Named> names_;
  std::vector<OfIsland> islands_;
  NumberHash hash_;
};

// One number over the present state alone.
uint64_t state_digest(const Plant& plant);

}  // namespace ipos::runtime
