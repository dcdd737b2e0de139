// RS-485 for tests: a unit with a few parameters as slave, a hand-driven station, and what an observer heard.
// All times the tests expect are computed here from the manual's figures, not taken from the code.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "runtime/bus/movilink/serial_master.hpp"
#include "runtime/bus/movilink/serial_slave.hpp"
#include "runtime/bus/rs485/line.hpp"
#include "tests/harness/proves.hpp"

namespace ipos::tests {

using namespace ipos::runtime;  // NOLINT: a test header, everything here is about the runtime

using Bytes = std::vector<uint8_t>;

// "02 01 05" with a correct BCC appended, or exactly as written.
inline Bytes hex(const std::string& text) {
  Bytes bytes;
  for (size_t at = 0; at + 1 < text.size(); at += 3)
    bytes.push_back(static_cast<uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16)));
  return bytes;
}
inline Bytes with_check(Bytes bytes) {
  uint8_t check = 0;
  for (const uint8_t byte : bytes) check ^= byte;
  bytes.push_back(check);
  return bytes;
}
inline Bytes telegram(const std::string& text) { return with_check(hex(text)); }
inline std::string text_of(std::span<const uint8_t> bytes) {
  std::string text;
  char two[4];
  for (const uint8_t byte : bytes) {
    std::snprintf(two, sizeof two, "%02X", byte);
    text += (text.empty() ? "" : " ") + std::string(two);
  }
  return text;
}

// Length of n characters of 11 bits, in nanoseconds.
constexpr Time wire_time(int characters, int baud) { return Time{11} * characters * kSecond / baud; }

struct Heard {
  Reception reception;
  NodeId sender;
  std::string text() const { return text_of(reception.bytes.span()); }
};

// The telegrams on a line and its events.
class Recorder final : public SerialObserver {
 public:
  void on_character(const Rs485Line&, NodeId sender, const Character& character) override {
    characters.push_back(character);
    if (const auto reception = receiver.take(character)) heard.push_back({*reception, sender});
  }
  void on_serial_event(const Rs485Line& line, const SerialEvent& event) override {
    events.push_back(event);
    texts.push_back(describe(line, event));
  }
  std::vector<std::string> all() const {
    std::vector<std::string> out;
    for (const Heard& h : heard) out.push_back(h.text());
    return out;
  }
  void clear() {
    heard.clear();
    characters.clear();
    events.clear();
    texts.clear();
  }
  SerialReceiver receiver;
  std::vector<Character> characters;
  std::vector<Heard> heard;
  std::vector<SerialEvent> events;
  std::vector<std::string> texts;
};

// The unit behind a slave.
class UnitModel final : public ParameterServer,
                        public ProcessDataServer,
                        public MasterSlaveDrive,
                        public SerialSlaveObserver {
 public:
  tl::expected<int32_t, ReturnCode> serve(Time, const ParameterRequest& request) override {
    requests.push_back(request);
    const auto found = parameters.find(request.index);
    if (found == parameters.end()) return tl::unexpected(return_codes::kInvalidIndex);
    if (!is_write(request.service)) return found->second;
    if (request.index == 8318) return tl::unexpected(return_codes::kReadOnly);
    return found->second = request.value;
  }
  void take_output(Time, OutputChannel channel, std::span<const uint16_t> words) override {
    std::copy(words.begin(), words.end(), output.begin());
    channels.push_back(channel);
  }
  ProcessWords input(Time) override { return inputs; }
  void synchronize(Time) override {}
  void cyclic_request(Time now) override { cyclic.push_back(now); }
  ProcessWords setpoint_to_send(Time) override { return setpoint; }
  void setpoint_received(Time now, const ProcessWords& words) override {
    setpoint = words;
    setpoints.push_back(now);
  }
  void link_lost(Time now) override { lost.push_back(now); }
  void on_rejected(Time, const Reception&, SerialError error) override { rejected.push_back(error); }
  void on_ignored(Time, const SerialTelegram&, Ignored reason, ReturnCode code) override {
    ignored.push_back(reason);
    last_code = code;
  }
  // Nothing has reached the unit.
  bool untouched() const { return requests.empty() && channels.empty() && cyclic.empty(); }

  std::map<int, int32_t> parameters = {{8318, 1'000'000}, {8470, 2000}};
  std::vector<ParameterRequest> requests;
  ProcessWords output{};
  ProcessWords inputs{0x0407, 0x3A98, 0};
  ProcessWords setpoint{};
  std::vector<OutputChannel> channels;
  std::vector<Time> cyclic;
  std::vector<Time> setpoints;
  std::vector<Time> lost;
  std::vector<SerialError> rejected;
  std::vector<Ignored> ignored;
  ReturnCode last_code;
};

// A unit on a line.
class SlaveNode final : public SerialNode {
 public:
  SlaveNode(EventQueue& queue, uint32_t source, Rs485Line& line, const std::string& name,
            SerialSlaveSettings settings, SerialSlaveTiming timing = {})
      : port(line, line.attach(name, line.baud(), *this)),
        slave(queue, source, port, settings, timing, unit, unit, unit, &unit) {}
  void on_character(Time now, const Character& character) override { slave.on_character(now, character); }
  void on_sent(Time now) override { slave.on_sent(now); }

  UnitModel unit;
  SerialLinePort port;
  SerialSlave slave;
};

// A station that sends what a test wants, when it wants.
class HandNode final : public SerialNode {
 public:
  HandNode(Rs485Line& line, const std::string& name, uint32_t baud)
      : port(line, line.attach(name, baud, *this)) {}
  HandNode(Rs485Line& line, const std::string& name) : HandNode(line, name, line.baud()) {}
  void on_character(Time, const Character& character) override {
    characters.push_back(character);
    if (const auto reception = receiver.take(character)) receptions.push_back(*reception);
  }
  void on_sent(Time now) override {
    sent.push_back(now);
    receiver.occupied(now);
  }
  void send(const Bytes& bytes) { EXPECT_TRUE(port.send(bytes)); }

  SerialLinePort port;
  SerialReceiver receiver;
  std::vector<Character> characters;
  std::vector<Reception> receptions;
  std::vector<Time> sent;
};

// A station that sends requests by the rules.
class RequestNode final : public SerialNode, public RequesterClient, public MovilinkClient {
 public:
  RequestNode(EventQueue& queue, uint32_t source, Rs485Line& line, const std::string& name,
              RequesterTiming timing = {})
      : port(line, line.attach(name, line.baud(), *this)),
        requester(queue, source, port, timing),
        master(queue, requester, *this) {}
  void on_character(Time now, const Character& character) override { requester.on_character(now, character); }
  void on_sent(Time now) override { requester.on_sent(now); }
  void on_request_done(Time now, RequestEnd end, const SerialTelegram* response) override {
    ends.push_back(end);
    end_times.push_back(now);
    if (response != nullptr) responses.push_back(*response);
  }
  void on_exchange_done(Time now, const MovilinkResult& result) override {
    results.push_back(result);
    end_times.push_back(now);
  }

  SerialLinePort port;
  SerialRequester requester;
  SerialMaster master;
  std::vector<RequestEnd> ends;
  std::vector<Time> end_times;
  std::vector<SerialTelegram> responses;
  std::vector<MovilinkResult> results;
};

// A sender that is no line: what was sent, and when.
class Wire final : public SerialSender {
 public:
  explicit Wire(EventQueue& queue) : queue_(queue) {}
  bool send(std::span<const uint8_t> bytes) override {
    sent.emplace_back(bytes.begin(), bytes.end());
    times.push_back(queue_.now());
    return true;
  }
  void break_off() override {}
  std::vector<Bytes> sent;
  std::vector<Time> times;

 private:
  EventQueue& queue_;
};

// A slave that is given characters with exact times, without a line.
struct SlaveBench {
  EventQueue queue;
  Wire wire{queue};
  UnitModel unit;
  SerialSlave slave;
  Time quiet_since = 0;

  explicit SlaveBench(SerialSlaveSettings settings, SerialSlaveTiming timing = {})
      : slave(queue, 1, wire, settings, timing, unit, unit, unit, &unit) {}

  // `pause` after the last character, then the bytes; before byte `gap_at` there is a gap.
  void feed(const Bytes& bytes, Time pause, size_t gap_at = ~size_t{0}, Time gap = 0, int baud = 9600) {
    Time at = quiet_since + pause;
    for (size_t n = 0; n < bytes.size(); ++n) {
      if (n == gap_at) at += gap;
      Character character = read_wire(wire_character(bytes[n]));
      character.start = at;
      character.end = at += wire_time(1, baud);
      feed(character);
    }
  }
  void feed(const Character& character) {
    queue.run_until(character.end);
    slave.on_character(character.end, character);
    quiet_since = character.end;
  }
  // Runs on until an answer would have been sent; the answers since the last call.
  std::vector<Bytes> answers() {
    queue.run_until(queue.now() + 100 * kMillisecond);
    quiet_since = queue.now();
    slave.on_sent(quiet_since);
    return std::exchange(wire.sent, {});
  }
};

}  // namespace ipos::tests
