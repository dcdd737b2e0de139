// A plant whose PROFIBUS has no master of its own: a test sends frames octet by octet, as `send` of a step does, and reads the
// answers off the line, as `frame` of a test and logs do. Requests are put together here, with the frame count bit as the norm wants it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/runtime/bus/profibus/dp_plant_rig.hpp"

namespace ipos::tests {

using runtime::kMicrosecond;
using runtime::kMillisecond;
using runtime::kSecond;
using runtime::Time;

// Set_Prm of a master that locks; watchdog 200 ms, min Tsdr 11.
inline const std::string kWatchdog = "88 14 01";
inline const std::string kNoWatchdog = "80 00 00";
inline const std::string kModes = "B0 00 00";  // Sync and Freeze, no watchdog
inline std::string prm_data(const std::string& begin = kWatchdog, const std::string& ident = "31 00",
                            const std::string& groups = "00") {
  return begin + " 0B " + ident + " " + groups;
}

struct HandPlant : DpPlant, private runtime::BusObserver {
  explicit HandPlant(const std::string& text, uint8_t slave = 8) : DpPlant(text), to(slave), bus(*plant->find_bus("dp")) {
    bus.add_observer(*this);
    bus.attach_hand();
    settle();
  }

  // A slave that hears good frames finds their rate.
  void settle(Time time = kSecond) {
    for (const Time end = plant->now() + time; plant->now() < end; run_on(5 * kMillisecond))
      EXPECT_EQ(bus.send("10 7D 00 49 fcs 16"), std::nullopt);
    masters.clear();
  }

  // SRD high with access points 62 and `dsap`, or without. What came back: "E5", "RS", "OK", "-" for nothing, else the octets of
  // the answer from its function code on, without addresses and access points.
  std::string ask(uint8_t master, std::optional<uint8_t> dsap, const std::string& data = "") {
    auto [known, is_new] = masters.try_emplace(to, master, true);
    auto& [last, bit] = known->second;
    const bool first = is_new || last != master;
    if (first) last = master, bit = true;
    const auto control = static_cast<uint8_t>(0x4D | (first ? 0x20 : bit ? 0x30 : 0x10));
    bit = !bit;
    Octets body{static_cast<uint8_t>(to | (dsap ? 0x80 : 0)), static_cast<uint8_t>(master | (dsap ? 0x80 : 0)), control};
    if (dsap) body.insert(body.end(), {*dsap, 62});
    return transmit(body, data);
  }
  std::string exchange(const std::string& outputs, uint8_t master = 1) { return ask(master, std::nullopt, outputs); }
  std::string diag(uint8_t master = 1) { return behind(ask(master, 60), 3); }
  std::string inputs(uint8_t master = 1) { return behind(ask(master, 56), 3); }
  std::string outputs(uint8_t master = 1) { return behind(ask(master, 57), 3); }
  // Global_Control to all, which nobody answers.
  std::string control(uint8_t command, uint8_t groups = 0, uint8_t master = 1) {
    return transmit({0xFF, static_cast<uint8_t>(0x80 | master), 0x46, 58, 62, command, groups}, "");
  }
  void start(const std::string& cfg, const std::string& prm = prm_data(), uint8_t master = 1) {
    EXPECT_EQ(ask(master, 61, prm), "E5");
    EXPECT_EQ(ask(master, 62, cfg), "E5");
  }
  // One cycle, a millisecond long: the parameter channel and the words behind it; the channel that came back.
  std::string channel(const std::string& octets, const std::string& words = "00 00") {
    const Time end = plant->now() + kMillisecond;
    const std::string answer = behind(exchange(octets + " " + words), 3);
    if (plant->now() < end) run(end);
    return answer.substr(0, 23);
  }
  // The same until the answer has the handshake bit of the request.
  std::string service(const std::string& octets, const std::string& words = "00 00") {
    std::string answer = channel(octets, words);
    for (int n = 0; n < 100 && !answer.empty() && ((hex(answer)[0] ^ hex(octets)[0]) & 0x40) != 0; ++n)
      answer = channel(octets, words);
    return answer;
  }

  uint8_t to;           // the slave that is asked
  runtime::Bus& bus;
  std::string meaning;  // of the last request, in words
  std::vector<runtime::BusMessage> heard;  // since that request

 private:
  void on_message(const runtime::Bus&, const runtime::BusMessage& message) override { heard.push_back(message); }
  static std::string behind(const std::string& text, size_t count) { return text.size() < count ? text : text.substr(count); }

  // SD2 around it. A slave begins to answer min Tsdr after the request; who says nothing for 300 bits has no answer.
  std::string transmit(const Octets& body, const std::string& data) {
    const size_t length = body.size() + hex(data).size();
    const Octets head{0x68, static_cast<uint8_t>(length), static_cast<uint8_t>(length), 0x68};
    heard.clear();
    EXPECT_EQ(bus.send(text_of(head) + " " + text_of(body) + (data.empty() ? "" : " " + data) + " fcs 16"), std::nullopt);
    const auto bits = [&](size_t count) { return static_cast<Time>(count * kSecond / bus.baud()); };
    run_on(bits(11 * (length + 6) + 2));
    EXPECT_EQ(heard.size(), 1U);
    meaning = heard.empty() ? "" : heard[0].meaning;
    for (size_t waited = 0; heard.size() < 2 && waited < 300 + 255 * 11; waited += 50) run_on(bits(50));
    run_on(bits(40));  // the next request wants an idle line
    return heard.size() < 2 ? "-" : answer_in(heard[1].bytes);
  }
  static std::string answer_in(const Octets& octets) {
    if (octets.size() == 1) return text_of(octets);
    if (octets[0] == 0x10) return octets[3] == 0x03 ? "RS" : "OK";
    const bool points = (octets[4] & 0x80) != 0;
    Octets rest(octets.begin() + (points ? 9 : 7), octets.end() - 2);
    rest.insert(rest.begin(), octets[6]);
    return text_of(rest);
  }

  std::map<uint8_t, std::pair<uint8_t, bool>> masters;  // who asked each slave last, and with which bit next
};

}  // namespace ipos::tests
