// Any characters and any traffic on RS-485: what is accepted is a telegram, a slave answers only what it
// accepted, a requester ends each request once, and the line keeps its promises with cuts, faults and changed
// rates.
#include <memory>
#include <string>
#include <vector>

#include "runtime/bus/log/serial_log.hpp"
#include "runtime/bus/movilink/line_check.hpp"
#include "runtime/bus/movilink/serial_master.hpp"
#include "runtime/bus/movilink/serial_slave.hpp"
#include "runtime/unit/unit_interface.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace ipos::runtime;  // NOLINT
using namespace ipos::tests;    // NOLINT
namespace stdlib = ipos::stdlib;

namespace {

// What a run costs is the traffic; more of it finds no more than other traffic.
constexpr size_t kLongest = 192;  // bytes of input
constexpr int kSteps = 24;
constexpr uint8_t kStations = 2;

// Characters with small and large gaps, seldom with errors.
Character character_from(Input& input, Time& now) {
  const uint8_t kind = input.u8();
  if (kind % 8 == 0) now += input.u8() * (kMillisecond / 16);
  Character character;
  character.start = now;
  character.end = now += character_time(kind % 2 == 0 ? 9'600 : 57'600);
  character.data = input.u8();
  character.parity_error = kind == 0xFF;
  character.framing_error = kind == 0xFE;
  return character;
}

void check_receiver(Input input) {
  SerialReceiver receiver;
  Time now = 0;
  while (!input.empty()) {
    const auto reception = receiver.take(character_from(input, now));
    require(receiver.receiving() == (receiver.deadline() != kNever), "a telegram under way has a deadline");
    if (!reception) continue;
    require(!serial_log_line("l", *reception).empty(), "a reception has a text");
    if (!reception->telegram) continue;
    const SerialBytes bytes = encode(*reception->telegram);
    require(std::equal(bytes.span().begin(), bytes.span().end(), reception->bytes.span().begin(),
                       reception->bytes.span().end()),
            "a telegram is encoded to the bytes it came from");
  }
}

struct Wire final : SerialSender {
  std::vector<SerialTelegram> sent;
  bool send(std::span<const uint8_t> bytes) override {
    const auto telegram = decode_serial(bytes);
    require(telegram.has_value(), "what a unit sends is a telegram");
    sent.push_back(*telegram);
    return true;
  }
  void break_off() override {}
};

void check_slave(Input input) {
  const stdlib::UnitType* units[] = {stdlib::find_unit(uint8_t{1}), stdlib::find_unit(uint8_t{3}),
                                     stdlib::find_unit(uint8_t{4})};
  UnitInterface drive(*units[input.u8() % 3]);
  EventQueue queue(kEvents);
  Wire wire;
  const SerialSlaveSettings settings{static_cast<uint8_t>(input.u8() % 100),
                                     static_cast<uint8_t>(100 + input.u8() % 100), input.u8() % 16 == 1,
                                     input.u8() % 2 == 1};
  SerialSlave slave(queue, 1, wire, settings, {}, drive, drive.rs485_data(), drive);
  SerialReceiver receiver;  // of the test: what there was to answer
  size_t requests = 0;
  Time now = 0;
  while (!input.empty()) {
    const Character character = character_from(input, now);
    queue.run_until(character.end);
    slave.on_character(character.end, character);
    const auto heard = receiver.take(character);
    if (heard && heard->telegram && !heard->telegram->response && is_answered(heard->telegram->address))
      ++requests;
  }
  queue.run_until(now + kSecond);
  require(wire.sent.size() <= requests, "a request has at most one answer");
  for (const SerialTelegram& answer : wire.sent)
    require(answer.response && (answer.address == settings.address || answer.address == kUniversalAddress),
            "a slave answers for its address");
  require(!settings.master_here || wire.sent.empty(), "a sender of setpoints answers nobody");
}

class Station final : public SerialNode, public RequesterClient, public MovilinkClient {
 public:
  Station(EventQueue& queue, uint32_t source, Rs485Line& line, const std::string& name, uint8_t address)
      : port(line, line.attach(name, line.baud(), *this)),
        drive(*stdlib::find_unit(uint8_t{1})),
        slave(queue, source, port, {address, 101}, {}, drive, drive.rs485_data(), drive),
        requester(queue, source, port),
        master(queue, requester, *this) {}
  void on_character(Time now, const Character& character) override {
    require(character.end <= now && character.start < character.end, "a character is heard at its end");
    slave.on_character(now, character);
    requester.on_character(now, character);
  }
  void on_sent(Time now) override {
    slave.on_sent(now);
    requester.on_sent(now);
  }
  void on_request_done(Time, RequestEnd end, const SerialTelegram* response) override {
    ++done;
    require((end == RequestEnd::Answered) == (response != nullptr), "an answer is there when there is one");
  }
  void on_exchange_done(Time, const MovilinkResult& result) override {
    ++exchanged;
    require(result.result == 0 || (!result.read_value && result.words == 0),
            "a failed exchange stores nothing");
  }
  SerialLinePort port;
  UnitInterface drive;
  SerialSlave slave;
  SerialRequester requester;
  SerialMaster master;
  int started = 0, done = 0, begun = 0, exchanged = 0;
};

struct Faults final : SerialFaults {
  explicit Faults(Input source) : input(source) {}
  void disturb(NodeId, std::vector<bool>& bits) override {
    const uint8_t kind = input.u8();
    if (kind % 8 == 1) bits[input.u8() % bits.size()].flip();
    if (kind % 8 == 2) bits.resize(input.u8() % (bits.size() + 1));
    if (kind % 8 == 3) bits.insert(bits.begin() + input.u8() % static_cast<int>(bits.size()), kind, true);
  }
  Input input;
};

void check_line(Input input) {
  EventQueue queue(kEvents);
  Rs485Line line(queue, 0, "line", input.u8() % 2 == 0 ? 9'600 : 57'600);
  uint64_t told = 0;
  LineCheck check([&told](Time, const std::string& text) { told += text.size(); });
  line.add_observer(check);
  Faults faults(input);
  line.set_faults(&faults);
  std::vector<std::unique_ptr<Station>> stations;
  for (uint8_t n = 0; n < kStations; ++n)
    stations.push_back(
        std::make_unique<Station>(queue, n + 1U, line, std::string(1, static_cast<char>('a' + n)), n));
  for (int steps = 0; !input.empty() && steps < kSteps; ++steps) {
    Station& station = *stations[input.u8() % kStations];
    const NodeId node = station.port.node();
    switch (input.u8() % 8) {
      case 0:
      case 1: {
        SerialTelegram request;
        request.address = input.u8();
        request.format = *telegram_format(input.u8() % 7 + (input.u8() % 2) * 128);
        station.requester.start(queue.now(), request, station);
        ++station.started;
        break;
      }
      case 2:
      case 3: {
        if (station.master.busy()) break;
        const MovilinkJob job{input.u8(),  input.u8() % 136, input.u8() % 5,
                              input.u16(), input.i32(),      {1, 2, 3}};
        if (!station.master.start(queue.now(), job)) ++station.begun;
        break;
      }
      case 4: line.set_connected(node, input.u8() % 4 != 0); break;
      case 5: line.set_baud(node, input.u8() % 4 == 0 ? 57'600 : 9'600); break;
      case 6: line.set_echo(node, input.u8() % 2 == 0); break;
      case 7: line.break_off(node); break;
    }
    queue.run_until(queue.now() + input.u8() * (kMillisecond / 2));
  }
  queue.run_until(queue.now() + 600 * kSecond);
  require(queue.pending() == 0 || queue.next_time() > queue.now(), "time goes on");
  const LineLoad load = line.load(queue.now());
  require(load.busy_bits <= load.elapsed_bits, "a line is not busy for longer than there is time");
  for (const auto& station : stations) {
    require(station->done == station->started && station->exchanged == station->begun, "a request ends once");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size > kLongest) return -1;  // not for the corpus
  Input input(data, size);
  switch (input.u8() % 4) {
    case 0: check_receiver(input); break;
    case 1: check_slave(input); break;
    default: check_line(input);
  }
  return 0;
}
