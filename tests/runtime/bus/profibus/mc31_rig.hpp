// A MOVITRAC 31 for tests: the parameters of its list with ranges, access and lock, and a drive that only keeps
// its words.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "runtime/bus/profibus/dp_unit.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/unit_types.hpp"
#include "tests/runtime/bus/profibus/slave_rig.hpp"

namespace ipos::tests {

inline const stdlib::ParameterTable& mc31_table() {
  return stdlib::parameter_table(*stdlib::find_unit("mc31"));
}
inline uint16_t index_of(const char* number) { return mc31_table().find(number)->index; }

struct Mc31 final : runtime::ParameterServer, FieldbusDrive {
  Mc31() {
    for (const stdlib::Parameter* p : mc31_table().by_index())
      values[p->index] = static_cast<int32_t>(p->default_value);
  }
  tl::expected<int32_t, ReturnCode> serve(Time, const runtime::ParameterRequest& request) override {
    namespace codes = runtime::return_codes;
    served.push_back(request);
    const stdlib::Parameter* p = mc31_table().find(request.index);
    if (p == nullptr) return tl::unexpected(codes::kInvalidIndex);
    if (request.service == runtime::Service::Write) {
      if (!p->writable) return tl::unexpected(codes::kReadOnly);
      if (locked) return tl::unexpected(codes::kParameterLock);
      if (request.value > p->maximum()) return tl::unexpected(codes::kTooLarge);
      if (request.value < p->minimum()) return tl::unexpected(codes::kTooSmall);
      values[p->index] = request.value;
    }
    return values[p->index];
  }
  int writes() const {
    int count = 0;
    for (const runtime::ParameterRequest& request : served)
      count += request.service == runtime::Service::Write;
    return count;
  }

  void take_output(Time, runtime::OutputChannel, std::span<const uint16_t> words) override {
    output.assign(words.begin(), words.end());
  }
  runtime::ProcessWords input(Time) override { return status; }
  void synchronize(Time) override {}
  void set_fieldbus_timeout(Time, int32_t hundredths) override { values[index_of("571")] = hundredths; }
  void fieldbus_timeout_expired(Time now) override { expired_at = now; }
  void set_fieldbus_address(Time, uint8_t address) override { values[index_of("073")] = address; }

  std::map<uint16_t, int32_t> values;
  std::vector<runtime::ParameterRequest> served;
  bool locked = false;
  std::vector<uint16_t> output;
  runtime::ProcessWords status{};
  std::optional<Time> expired_at;
};

// With a slave before it, and a master of a few lines.
struct Mc31Bench {
  explicit Mc31Bench(const std::string& cfg = "F3 F2", const std::string& prm_data = prm("88 14 01")) {
    start(cfg, prm_data);
  }
  void start(const std::string& cfg, const std::string& prm_data) {
    EXPECT_EQ(ask(61, prm_data), "E5");
    EXPECT_EQ(ask(62, cfg), "E5");
  }
  std::string ask(std::optional<uint8_t> dsap, const std::string& data) {
    const auto fc = static_cast<uint8_t>(0x4D | (first ? 0x20 : bit ? 0x30 : 0x10));
    first = false;
    bit = !bit;
    const auto ssap = dsap ? std::optional<uint8_t>(62) : std::nullopt;
    const auto answer = slave.on_frame(now, {Delimiter::SD2, 8, 1, fc, dsap, ssap, hex(data)});
    if (!answer) return "-";
    return answer->is_acknowledgement() ? "E5" : text_of(answer->data);
  }
  // One cycle: the channel and three words; the channel that came back.
  std::string channel(const std::string& octets, const std::string& words = "00 00 00 00 00 00") {
    now += kMillisecond;
    return ask(std::nullopt, octets + " " + words).substr(0, 23);
  }
  // The same until the service is done.
  std::string service(const std::string& octets) {
    std::string answer;
    for (int cycle = 0; cycle < 15; ++cycle) answer = channel(octets);
    return answer;
  }

  Mc31 drive;
  FieldbusParameters parameters{drive, mc31_table()};
  DpUnit unit{parameters, drive};
  DpSlave slave{{8, 0x3100}, unit};
  Time now = 0;
  bool first = true;
  bool bit = true;
};

}  // namespace ipos::tests
