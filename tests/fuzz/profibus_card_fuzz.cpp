// The parameter channel and the FMS services of a card on PROFIBUS, in any order: no parameter leaves its range, every
// service has one end, the slave goes on.
#include <map>

#include "runtime/bus/profibus/card.hpp"
#include "runtime/bus/profibus/dp_unit.hpp"
#include "runtime/bus/profibus/fms/server.hpp"
#include "runtime/bus/profibus/fms_objects.hpp"
#include "stdlib/unit_types.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace ipos::profibus;  // NOLINT
using namespace ipos::tests;     // NOLINT
namespace runtime = ipos::runtime;
namespace stdlib = ipos::stdlib;

namespace {

constexpr uint8_t kServices = 0
#define FMS_SERVICE(name, feature, confirmed, number, of_object, text) +1
#include "runtime/bus/profibus/fms/services.def"
    ;

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
  fms::Server server(objects, option_type(static_cast<OptionKind>(input.u8() % 2)).fms);
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
        if (const fms::Connection* connection = fms::find_connection(cref))
          server.initiate(now, cref, 2, master_entry(*connection, 8));
        break;
      case 1: server.abort(cref); break;
      case 2: server.expire(now, cref); break;
      case 3:
      case 4: {
        fms::Request request{static_cast<fms::Service>(input.u8() % kServices), index_from(input), {}};
        request.data.resize(input.u8());
        for (uint8_t& octet : request.data) octet = input.u8();
        server.request(now, cref, request);
        break;
      }
      case 5:
        if (const auto response = server.response(now, cref))
          require(response->end != fms::End::Positive || response->data.size() <= 241,
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
  check_card({data, size});
  return 0;
}
