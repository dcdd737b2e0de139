// A slave by itself, and a master of a few lines that asks it frame by frame with the frame count bit as the
// norm wants it. The unit behind the slave only keeps what it is given.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "runtime/bus/profibus/dp_slave.hpp"
#include "tests/runtime/bus/profibus/octets.hpp"

namespace ipos::tests {

using runtime::kMillisecond;
using runtime::kSecond;

// Inputs count up with each reading, so that a frozen image is told from a new one.
struct FakeUnit final : SlaveUnit {
  void configured(Time, const Configuration& configuration) override {
    name = configuration.name;
    outputs.assign(configuration.octets, 0);
  }
  void take_outputs(Time now, std::span<const uint8_t> octets) override {
    outputs.assign(octets.begin(), octets.end());
    ++taken;
    taken_at = now;
  }
  void read_inputs(Time now, std::span<uint8_t> octets) override {
    ++readings;
    read_at = now;
    std::fill(octets.begin(), octets.end(), readings);
  }
  void watchdog_set(Time, std::optional<Time> period) override { watchdog = period; }
  void watchdog_expired(Time now) override {
    ++expired;
    expired_at = now;
  }
  void exchanged(Time now) override { exchanges.push_back(now); }
  void exchange_ended(Time) override { ++ended; }

  std::string name;
  Octets outputs;
  int taken = 0;
  Time taken_at = 0;
  uint8_t readings = 0;
  Time read_at = 0;
  std::optional<Time> watchdog;
  int expired = 0;
  Time expired_at = 0;
  int ended = 0;
  std::vector<Time> exchanges;
};

struct Notes final : SlaveObserver {
  void on_note(Time, SlaveNote note, uint8_t) override { all.push_back(note); }
  bool last_is(SlaveNote note) const { return !all.empty() && all.back() == note; }
  std::vector<SlaveNote> all;
};

// Set_Prm of a master that locks, with groups; min Tsdr 11.
inline std::string prm(const std::string& watchdog = "88 14 01", const std::string& ident = "31 00",
                       const std::string& groups = "00") {
  return watchdog + " 0B " + ident + " " + groups;
}
inline const std::string kNoWatchdog = "80 00 00";
inline const std::string kModes = "B0 00 00";  // Sync and Freeze, no watchdog

struct SlaveBench {
  explicit SlaveBench(SlaveSettings settings = {8, 0x3100}) : slave(settings, unit, &notes) {}

  // SRD high; what came back as text: "E5", "RS", or the answer's data behind its function.
  std::string ask(uint8_t master, std::optional<uint8_t> dsap, const Octets& data) {
    const bool known = master == last_master;
    const auto fc = static_cast<uint8_t>(0x4D | (known ? (bit ? 0x30 : 0x10) : 0x20));
    if (!known) bit = true;
    last_master = master;
    bit = !bit;
    const auto ssap = dsap ? std::optional<uint8_t>(62) : std::nullopt;
    last_request = {Delimiter::SD2, slave.address(), master, fc, dsap, ssap, data};
    return answer_of(slave.on_frame(now, last_request));
  }
  std::string ask(uint8_t master, uint8_t dsap, const std::string& data = "") {
    return ask(master, std::optional<uint8_t>(dsap), hex(data));
  }
  std::string exchange(uint8_t master, const std::string& outputs) {
    return ask(master, std::nullopt, hex(outputs));
  }
  std::string diag(uint8_t master = 1) { return ask(master, 60).substr(3); }
  void control(uint8_t master, uint8_t command, uint8_t groups = 0) {
    EXPECT_FALSE(slave.on_frame(now, {Delimiter::SD2, 127, master, 0x46, 58, 62, {command, groups}}));
  }
  void start(uint8_t master = 1, const std::string& parameters = prm(), const std::string& cfg = "F2") {
    EXPECT_EQ(ask(master, 61, parameters), "E5");
    EXPECT_EQ(ask(master, 62, cfg), "E5");
    EXPECT_EQ(slave.state(), SlaveState::DataExchange);
  }

  std::string answer_of(const std::optional<FdlFrame>& answer) {
    if (!answer) return "-";
    if (answer->is_acknowledgement()) return "E5";
    EXPECT_EQ(answer->source, slave.address());
    EXPECT_EQ(answer->destination, last_request.source);
    if (answer->kind == Delimiter::SD1) return answer->control == 0x03 ? "RS" : "OK";
    EXPECT_EQ(answer->dsap, last_request.ssap);
    EXPECT_EQ(answer->ssap, last_request.dsap);
    return text_of(Octets{answer->control}) + (answer->data.empty() ? "" : " " + text_of(answer->data));
  }

  FakeUnit unit;
  Notes notes;
  DpSlave slave;
  Time now = 0;
  uint8_t last_master = 255;
  bool bit = false;
  FdlFrame last_request;
};

}  // namespace ipos::tests
