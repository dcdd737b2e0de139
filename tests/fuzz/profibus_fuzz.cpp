// Any octets, any sequence of frames and any traffic on PROFIBUS: what is accepted is a frame, a slave answers
// once and only what is for it, its unit gets outputs only in data exchange and of the configured length, and
// a line with masters and faults goes on.
#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/bus/profibus/dp_unit.hpp"
#include "runtime/bus/profibus/fms_server.hpp"
#include "runtime/bus/profibus/frame_text.hpp"
#include "runtime/bus/profibus/master.hpp"
#include "runtime/bus/profibus/slave_station.hpp"
#include "stdlib/unit_types.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace ipos::profibus;  // NOLINT
using namespace ipos::tests;     // NOLINT
namespace runtime = ipos::runtime;
namespace stdlib = ipos::stdlib;

namespace {

void check_decoder(const uint8_t* data, size_t size) {
  const auto frame = decode({data, size});
  if (!frame) return;
  const Octets octets = encode(*frame);
  require(std::equal(octets.begin(), octets.end(), data, data + size), "a frame is its own octets");
  require(!describe(*frame).empty(), "a frame has a text");
}

void check_receiver(Input input) {
  FdlReceiver receiver(input.u8() % 2 == 0 ? strict_limits(500'000) : kPortLimits);
  Time now = 0;
  while (!input.empty()) {
    const uint8_t kind = input.u8();
    if (kind % 8 == 0) now += input.u8() * (runtime::kMillisecond / 16);
    runtime::Character character;
    character.start = now;
    character.end = now += 22 * runtime::kMicrosecond;
    character.data = input.u8();
    character.parity_error = kind == 0xFF;
    character.framing_error = kind == 0xFE;
    for (const Reception& reception : receiver.take(character)) {
      require(!reception.octets.empty() && reception.start < reception.end,
              "a reception has octets and time");
      if (reception.frame)
        require(encode(*reception.frame) == reception.octets, "a frame heard is its own octets");
    }
  }
}

struct Unit final : SlaveUnit {
  void configured(Time, const Configuration& configuration) override { octets = configuration.octets; }
  void take_outputs(Time, std::span<const uint8_t> outputs) override {
    require(octets != 0 && outputs.size() == octets, "outputs come in data exchange, as configured");
  }
  void read_inputs(Time, std::span<uint8_t> inputs) override {
    require(octets != 0 && inputs.size() == octets, "inputs are read in data exchange, as configured");
  }
  void watchdog_set(Time, std::optional<Time> period) override {
    require(!period || *period >= 10 * runtime::kMillisecond, "a watchdog has a time");
  }
  void watchdog_expired(Time) override { octets = 0; }
  void exchange_ended(Time) override {
    require(octets != 0, "what ends has begun");
    octets = 0;
  }
  size_t octets = 0;
};

// Frames that are often to the point: the services, with right and wrong data.
FdlFrame frame_from(Input& input) {
  const uint8_t kind = input.u8();
  const uint8_t master = input.u8() % 4 == 0 ? 2 : 1;
  const uint8_t code = kind % 16 == 0 ? input.u8() : static_cast<uint8_t>(0x4D | (input.u8() & 0x30));
  const auto srd = [&](uint8_t point, Octets data) {
    return make_frame(8, master, code, point, kMasterAccessPoint, std::move(data));
  };
  const auto any = [&input](size_t most) {
    Octets data(input.below(static_cast<uint32_t>(most)));
    for (uint8_t& octet : data) octet = input.u8();
    return data;
  };
  switch (kind / 16) {
    case 0: return srd(60, {});
    case 1:
    case 2: return srd(61, {static_cast<uint8_t>(0x80 | input.u8()), input.u8(), 1, 11, 0x31, 0, input.u8()});
    case 3: return srd(61, any(12));
    case 4: {
      const auto all = configurations();
      return srd(62, all[input.u8() % all.size()].cfg_data());
    }
    case 5: return srd(62, any(6));
    case 6:
    case 7: {
      const auto all = configurations();
      return make_frame(8, master, code, {}, {}, Octets(all[input.u8() % all.size()].octets, kind));
    }
    case 8: return make_frame(8, master, code, {}, {}, any(245));
    case 9: return make_frame(kBroadcast, master, 0x46, 58, kMasterAccessPoint, {input.u8(), input.u8()});
    case 10: return srd(56, {});
    case 11: return srd(57, {});
    case 12: return srd(input.u8() % 64, any(16));
    case 13: return make_frame(8, master, static_cast<uint8_t>(0x40 | input.u8()));
    case 14: return make_token(input.u8() % 127, input.u8() % 127);
    default: return make_frame(input.u8() % 128, input.u8() % 127, input.u8(), input.u8() % 64, {}, any(20));
  }
}

void check_slave(Input input) {
  Unit unit;
  DpSlave slave({8, 0x3100}, unit);
  Time now = 0;
  while (!input.empty()) {
    const uint8_t pause = input.u8();
    if (pause > 200) now += (pause - 200) * 5 * runtime::kMillisecond;
    slave.expire(now);
    const FdlFrame request = frame_from(input);
    const auto answer = slave.on_frame(now, request);
    require((slave.state() == SlaveState::DataExchange) == (unit.octets != 0), "the unit knows the state");
    if (!answer) continue;
    require(request.is_request() && request.destination == 8, "only requests to its address are answered");
    require(answer->is_answer(), "an answer is one");
    require(answer->is_acknowledgement() || (answer->source == 8 && answer->destination == request.source),
            "an answer goes to who asked");
    require(decode(encode(*answer)) == *answer, "an answer is a frame");
    require(describe(slave.diagnosis(now)).size() > 8, "a diagnosis has a text");
  }
}

void check_line(Input input) {
  runtime::EventQueue queue;
  Line line(queue, 0, "dp", kBaudRates[input.u8() % std::size(kBaudRates)].baud);
  Unit units[2];
  std::vector<std::unique_ptr<SlaveStation>> slaves;
  std::vector<std::unique_ptr<Master>> masters;
  for (uint8_t n = 0; n < 2; ++n) {
    slaves.push_back(std::make_unique<SlaveStation>(queue, n + 1U, line, "slave",
                                                    option_type(static_cast<OptionKind>(n)),
                                                    CardSwitches{static_cast<uint8_t>(10 + n)}, units[n]));
    MasterSettings settings;
    settings.address = static_cast<uint8_t>(input.u8() % 8 + 8 * n);  // never the same
    settings.gap_factor = input.u8() % 4;
    masters.push_back(std::make_unique<Master>(queue, n + 3U, line, "master", settings));
    PrmData prm;
    prm.lock = prm.sync = prm.freeze = true;
    prm.watchdog = n == 0;
    prm.watchdog_factor_1 = prm.watchdog_factor_2 = 3;
    prm.ident = option_type(static_cast<OptionKind>(n)).ident;
    masters[n]->add_slave({static_cast<uint8_t>(10 + n), prm, {0xF0}, 2, 2});
    masters[n]->start();
  }
  LineFault fault;
  fault.kind = static_cast<LineFaultKind>(input.u8() % 5);
  fault.per_mille = input.u8();
  fault.seed = input.u16();
  line.add_fault(fault);
  for (int steps = 0; !input.empty() && steps < 50; ++steps) {
    Master& master = *masters[input.u8() % 2];
    switch (input.u8() % 8) {
      case 0: master.stop(); break;
      case 1: master.stop(), master.start(); break;
      case 2: master.control({input.u8(), input.u8()}); break;
      case 3: line.set_connected(master.node(), input.u8() % 4 != 0); break;
      case 4: line.set_connected(slaves[input.u8() % 2]->node(), input.u8() % 4 != 0); break;
      case 5: slaves[input.u8() % 2]->power_on(input.u8() % 2 == 0); break;
      case 6: slaves[input.u8() % 2]->slave().set_fault(queue.now(), input.u8()); break;
      default: break;
    }
    const Time until = queue.now() + input.u8() * (runtime::kMillisecond / 64);
    for (int events = 0; queue.next_time() <= until; ++events) {
      require(events < 20'000, "time goes on");
      queue.step();
    }
    queue.run_until(until);
  }
  const runtime::LineLoad load = line.load(queue.now());
  require(load.busy_bits <= load.elapsed_bits + 300 * kCharacterBits, "a line is not busier than time");
}

// The parameters of the list with their ranges, and a drive that takes at most three words.
struct Inverter final : runtime::ParameterServer, FieldbusDrive {
  tl::expected<int32_t, ReturnCode> serve(Time, const runtime::ParameterRequest& request) override {
    namespace codes = runtime::return_codes;
    const stdlib::Parameter* parameter = table.find(request.index);
    if (parameter == nullptr) return tl::unexpected(codes::kInvalidIndex);
    int32_t& value = values[request.index];
    if (request.service == runtime::Service::Read) return value;
    if (!parameter->writable) return tl::unexpected(codes::kReadOnly);
    if (request.value < parameter->minimum()) return tl::unexpected(codes::kTooSmall);
    if (request.value > parameter->maximum()) return tl::unexpected(codes::kTooLarge);
    return value = request.value;
  }
  void take_output(Time, runtime::OutputChannel, std::span<const uint16_t> words) override {
    require(!words.empty() && words.size() <= 3, "one to three process data words");
  }
  runtime::ProcessWords input(Time) override { return {1, 2, 3}; }
  void synchronize(Time) override {}
  void set_fieldbus_timeout(Time, int32_t hundredths) override {
    require(hundredths > 0 && hundredths <= 65'000, "P571 keeps its range");
  }
  void fieldbus_timeout_expired(Time) override {}
  void set_fieldbus_address(Time, uint8_t) override {}

  const stdlib::ParameterTable& table = stdlib::parameter_table(*stdlib::find_unit("mc31"));
  std::map<uint16_t, int32_t> values;
};

// An index near those that exist, or any.
uint16_t index_from(Input& input) {
  const uint8_t kind = input.u8();
  if (kind % 4 == 0) return input.u16();
  return static_cast<uint16_t>((kind % 4 == 1 ? 980 : 1000) + input.u8());
}

// The parameter channel and FMS reach the same parameters: no value leaves its range, every service has one end.
void check_card(Input input) {
  Inverter inverter;
  FieldbusParameters parameters(inverter, inverter.table);
  DpUnit unit(parameters, inverter);
  DpSlave slave({8, 0x3100}, unit);
  FmsObjects objects(parameters, inverter, slave);
  FmsServer fms(objects, option_type(static_cast<OptionKind>(input.u8() % 2)));
  Time now = 0;
  const auto ask = [&](std::optional<uint8_t> point, Octets data) {
    return slave.on_frame(
        now, make_frame(8, 1, static_cast<uint8_t>(0x4D | (input.u8() & 0x30)), point,
                        point ? std::optional(kMasterAccessPoint) : std::nullopt, std::move(data)));
  };
  ask(61, {0x80, 0, 0, 11, 0x31, 0, 0});
  ask(62, {0xF3, 0xF2});
  while (!input.empty()) {
    now += input.u8() * (runtime::kMillisecond / 8);
    const uint8_t cref = input.u8() % 10;
    switch (input.u8() % 8) {
      case 0:
        if (const FmsConnection* connection = find_fms_connection(cref))
          fms.initiate(now, cref, 2, master_entry(*connection, 8));
        break;
      case 1: fms.abort(cref); break;
      case 2: fms.expire(now, cref); break;
      case 3:
      case 4: {
        FmsRequest request{static_cast<FmsService>(input.u8() % 24), index_from(input), {}};
        request.data.resize(input.u8());
        for (uint8_t& octet : request.data) octet = input.u8();
        fms.request(now, cref, request);
        break;
      }
      case 5:
        if (const auto response = fms.response(now, cref))
          require(response->end != FmsEnd::Positive || response->data.size() <= 241,
                  "a response fits into its PDU");
        break;
      default: {
        const uint16_t index = index_from(input);
        Octets outputs = {input.u8(),
                          0,
                          static_cast<uint8_t>(index >> 8),
                          static_cast<uint8_t>(index),
                          input.u8(),
                          input.u8(),
                          input.u8(),
                          input.u8(),
                          0,
                          6,
                          input.u8(),
                          input.u8(),
                          0,
                          0};
        const auto answer = ask({}, std::move(outputs));
        require(answer.has_value(), "a request is answered");
        require(
            slave.state() != SlaveState::DataExchange || answer->data.size() == 14 || answer->data.empty(),
            "inputs are as long as configured");
      }
    }
    for (const auto& [index, value] : inverter.values) {
      const stdlib::Parameter* parameter = inverter.table.find(index);
      require(value == 0 || (value >= parameter->minimum() && value <= parameter->maximum()),
              "values keep their range");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  check_decoder(data, size);
  Input input(data, size);
  switch (input.u8() % 8) {  // the line takes far longer than the others
    case 0: check_line(input); break;
    case 1: check_receiver(input); break;
    case 2:
    case 3: check_card(input); break;
    default: check_slave(input); break;
  }
  return 0;
}
