// Any frames to the MOVILINK telegrams of SBus: codecs that lose nothing, a slave that answers its own
// address only and at most once, a master that ends each exchange exactly once.
#include <vector>

#include "runtime/bus/movilink/sbus_master.hpp"
#include "runtime/bus/movilink/sbus_slave.hpp"
#include "runtime/bus/movilink/variable_telegram.hpp"
#include "runtime/unit/unit_interface.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace ipos::runtime;  // NOLINT
using namespace ipos::tests;    // NOLINT
namespace stdlib = ipos::stdlib;

namespace {

struct Wire final : FrameSender {
  std::vector<Frame> sent;
  SendStatus send(const Frame& frame, uint64_t) override {
    require(is_valid(frame) && is_plain(frame), "an SBus telegram is a plain frame");
    sent.push_back(frame);
    return SendStatus::Queued;
  }
  void withdraw(uint64_t) override {}
};

struct Client final : MovilinkClient {
  int done = 0;
  void on_exchange_done(Time, const MovilinkResult& result) override {
    ++done;
    require(result.words <= 3, "a telegram has at most three process data words");
    require(result.result == 0 || (!result.read_value && result.words == 0),
            "a failed exchange stores nothing");
  }
};

Frame frame_from(Input& input) {
  Frame frame;
  const uint8_t kind = input.u8();
  frame.length = kind % 9;
  frame.extended = kind % 32 == 31;
  frame.remote = kind % 32 == 30;
  frame.id = input.u16() % (frame.extended ? kExtendedIdLimit : kStandardIdLimit);
  for (uint8_t& byte : frame.data) byte = input.u8();
  return canonical(frame);
}

void check_codecs(Input input) {
  const Frame frame = frame_from(input);
  const ParameterTelegram telegram = decode_parameter(frame.data);
  require(encode(telegram) == frame.data, "a telegram is encoded to the bytes it came from");
  require(ReturnCode::unpack(telegram.data).packed() == telegram.data, "a return code loses nothing");
  require(parameter_refusal(telegram, telegram.return_code()).return_code() == telegram.return_code(),
          "a refusal carries its code");
  require(!describe(telegram.return_code()).empty(), "a return code has a text");
  const auto format = variable_format(input.i32() % 0x120);
  if (!format) return;
  const auto pair = frame_variables(frame, *format);
  if (pair)
    require(variable_frame(frame.id, *format, *pair) == frame,
            "variables are sent as the frame they came in");
}

void check_slave(Input input) {
  const stdlib::UnitType* units[] = {stdlib::find_unit(uint8_t{1}), stdlib::find_unit(uint8_t{3}),
                                     stdlib::find_unit(uint8_t{4})};
  UnitInterface drive(*units[input.u8() % 3]);
  EventQueue queue(kEvents);
  Wire wire;
  SlaveSettings settings{static_cast<uint8_t>(input.u8() % 64), static_cast<uint8_t>(input.u8() % 64),
                         static_cast<uint16_t>(input.u16() % kStandardIdLimit)};
  const uint8_t choice = input.u8();
  settings.second_channel = choice % 2 == 0;
  settings.synchronous = choice / 2 % 4 != 0;
  settings.group_output = choice / 8 % 4 != 0;
  SbusSlave slave(queue, 1, wire, 1, settings, {}, drive, drive);
  size_t received = 0;
  while (!input.empty()) {
    slave.on_frame(queue.now(), frame_from(input));
    ++received;
    queue.run_until(queue.now() + input.u8() * (kMillisecond / 8));
    require(wire.sent.size() <= received, "a telegram has at most one answer");
  }
  queue.run_until(queue.now() + kSecond);
  require(wire.sent.size() <= received, "a telegram has at most one answer");
  for (const Frame& answer : wire.sent) {
    const auto id = classify_identifier(answer.id);
    require(id && id->address == settings.address && !telegram_type(id->telegram).from_master,
            "a slave sends answers of its own address");
    require(answer.length == (telegram_type(id->telegram).parameter ? 8 : 6),
            "an answer has the length of its kind");
  }
}

void check_master(Input input) {
  EventQueue queue(kEvents);
  Wire wire;
  Client client;
  SbusMaster master(queue, 1, wire, 1, kSbusReplyTimeout, client);
  int started = 0;
  while (!input.empty()) {
    if (!master.busy()) {
      MovilinkJob job{input.u8() - 4,           input.u8() % 140, input.u8() % 12 - 1,
                      input.i32() % 0x100'0000, input.i32(),      {}};
      for (int32_t& word : job.output) word = input.i32();
      const auto refused = master.start(queue.now(), job);
      require(master.busy() != refused.has_value(), "a job is refused or begun");
      started += !refused;
    }
    if (input.u8() % 8 == 0) master.on_sent(queue.now(), 1);
    master.on_frame(queue.now(), frame_from(input));
    queue.run_until(queue.now() + input.u8() * (kMillisecond / 4));
  }
  queue.run_until(queue.now() + kSecond);
  require(!master.busy() && client.done == started, "each exchange ends once");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const Input input(data, size);
  check_codecs(input);
  check_slave(input);
  check_master(input);
  return 0;
}
