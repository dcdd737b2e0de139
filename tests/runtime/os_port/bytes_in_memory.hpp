// A serial port in memory: the test puts in what arrives, in order of time.
#pragma once

#include <deque>
#include <span>
#include <string>
#include <vector>

#include "runtime/os_port/serial_port.hpp"

namespace ipos::tests {

using namespace ipos::runtime;  // NOLINT: a test header, everything here is about the runtime

class BytesInMemory final : public BytePort {
 public:
  explicit BytesInMemory(RealClock& clock) : clock_(clock) {}
  const std::string& name() const override { return name_; }
  PortNeeds needs() const override { return {}; }
  tl::expected<void, PortError> flush() override { return {}; }
  size_t waiting() const override { return 0; }
  const PortCounts& counts() const override { return counts_; }
  std::vector<std::string> take_notes() override { return {}; }
  bool has_parity() const override { return true; }
  bool paces() const override { return paced; }
  Time latency() const override { return late; }
  void send(std::span<const uint8_t> bytes) override {
    if (!bytes.empty()) sent.push_back({clock_.now(), {bytes.begin(), bytes.end()}});
  }
  tl::expected<size_t, PortError> receive(std::span<ByteArrival> into) override {
    size_t count = 0;
    for (; count < into.size() && !incoming.empty() && incoming.front().at <= clock_.now(); ++count) {
      into[count] = incoming.front();
      incoming.pop_front();
    }
    counts_.received += count;
    return count;
  }

  struct Sent {
    Time at;
    std::vector<uint8_t> bytes;
  };
  std::deque<ByteArrival> incoming;
  std::vector<Sent> sent;
  bool paced = true;
  Time late = 0;

 private:
  RealClock& clock_;
  std::string name_ = "serial";
  PortCounts counts_;
};

}  // namespace ipos::tests
