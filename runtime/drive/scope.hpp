// The scope in the unit: records display values every few milliseconds, from some time before a trigger on. The manuals
// name a scope in the unit (11264926 chapter 8.7.4) and parameters of it (1053 1610 p. 67), no more: how it works is ours.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ipos::runtime {

class Scope {
 public:
  static constexpr size_t kChannels = 4;
  static constexpr uint32_t kMostSamples = 1000;  // of each channel
  using Sample = std::array<int32_t, kChannels>;

  enum class State : uint8_t { Off, Filling, Waiting, Recording, Done };
  enum class Edge : uint8_t { None, Rising, Falling };  // of channel 1 through the level

  struct Order {
    uint32_t every = 1;  // ms
    Edge edge = Edge::None;
    int32_t level = 0;
    uint32_t samples = 500;
    uint32_t before = 0;  // of the samples: those before the trigger
  };

  // What there was is lost. Numbers are brought to where they make sense.
  void start(const Order& order);
  void stop() { state_ = State::Off; }
  bool runs() const { return state_ != State::Off && state_ != State::Done; }
  State state() const { return state_; }

  // A millisecond is over. True: a sample is due.
  bool tick();
  void take(const Sample& sample);

  // Of what is recorded, the oldest is 0.
  uint32_t recorded() const { return static_cast<uint32_t>(samples_.size()); }
  int32_t value(size_t channel, uint32_t sample) const {
    return samples_[(oldest_ + sample) % samples_.size()][channel];
  }
  uint32_t before() const { return order_.before; }

 private:
  void store(const Sample& sample);
  bool triggers(int32_t value) const;

  Order order_;
  State state_ = State::Off;
  uint32_t wait_ = 0;  // ms until the next sample
  uint32_t left_ = 0;  // samples before or after the trigger that are still to come
  std::vector<Sample> samples_;
  size_t oldest_ = 0;
};

}  // namespace ipos::runtime
