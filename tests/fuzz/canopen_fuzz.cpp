// Any frames to a CANopen node and to those who listen: one answer at most to an SDO request, PDOs that are never
// longer than eight bytes, a dictionary whose rules hold whatever was written, a client that ends, a text for all.
#include <map>
#include <vector>

#include "runtime/bus/canopen/node.hpp"
#include "runtime/bus/canopen/sdo_client.hpp"
#include "runtime/bus/canopen/words.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace ipos::runtime;           // NOLINT
using namespace ipos::runtime::canopen;  // NOLINT
using namespace ipos::tests;             // NOLINT
namespace stdlib = ipos::stdlib;

namespace {

constexpr uint8_t kNumber = 5;

struct Wire final : FrameSender {
  size_t sent = 0, sdo = 0;
  LineWords* words = nullptr;
  SendStatus send(const Frame& frame, uint64_t) override {
    require(is_valid(frame) && is_plain(frame), "a node sends plain frames");
    require(frame.id != identifier(Connection::Nmt), "a node commands nobody");
    ++sent;
    sdo += frame.id == identifier(Connection::SdoResponse, kNumber) && frame.length == 8;
    words->describe(frame);
    return SendStatus::Queued;
  }
  void withdraw(uint64_t) override {}
};

struct FuzzUnit final : canopen::Unit, ParameterServer {
  tl::expected<int32_t, ReturnCode> serve(Time, const ParameterRequest& request) override {
    if (request.index % 3 == 0) return tl::unexpected(return_codes::kInvalidIndex);
    if (is_write(request.service) && request.index % 3 == 1) return tl::unexpected(return_codes::kTooLarge);
    return request.value;
  }
  void take_output(Time, const Words&, uint16_t written) override {
    require(written != 0 && written < 1U << objects::kProcessWords, "some of the ten words are written");
    require(operational, "outputs are taken in operational only");
  }
  Words input(Time, uint16_t) override { return words; }
  UnitStatus status(Time) override { return {0x0203, (words[0] & 1) != 0, (words[0] & 2) != 0}; }
  void synchronize(Time) override {}
  void state_changed(Time, State state) override { operational = state == State::Operational; }
  void reset_node(Time) override {}
  void partner_lost(Time) override {
    require(!lost, "a partner is lost once");
    lost = true;
  }
  void partner_back(Time) override {
    require(lost, "only who was lost comes back");
    lost = false;
  }
  Words words{};
  bool operational = false, lost = false;
};

// Often to an object that has rules.
Frame frame_from(Input& input) {
  Frame frame;
  const uint8_t kind = input.u8();
  if (kind < 128) {
    constexpr uint16_t kIndices[] = {0x1400, 0x1401, 0x1600, 0x1601, 0x1800, 0x1801, 0x1A00, 0x1A01, 0x1005,
                                     0x1014, 0x1015, 0x1016, 0x1017, 0x100C, 0x100D, 0x2000, 0x1003, 0x1008};
    constexpr uint8_t kCommands[] = {0x23, 0x2B, 0x2F, 0x40, 0x21, 0x60, 0x70, 0x01, 0x11, 0x22};
    const uint16_t index = kIndices[input.u8() % std::size(kIndices)];
    const uint8_t command = kCommands[kind % std::size(kCommands)];
    const uint8_t sub = input.u8() % 9;
    return {identifier(Connection::SdoRequest, kNumber), 8,
            sdo::initiate(command, {index, sub}, input.u32())};
  }
  frame.length = kind % 9;
  frame.remote = kind % 16 == 15;
  frame.id = input.u16() % kStandardIdLimit;
  if (kind >= 192) frame.id = kind % 3 == 0 ? 0x000 : kind % 3 == 1 ? 0x080 : 0x205;
  if (frame.id == 0) frame.length = 2;
  for (uint8_t& byte : frame.data) byte = input.u8();
  return canonical(frame);
}

void check_mapping(const ObjectDictionary& dictionary) {
  for (const uint16_t first : {objects::kReceivePdo, objects::kTransmitPdo})
    for (uint8_t n = 0; n < objects::kPdos; ++n) {
      const Mapping mapping = mapping_of(dictionary, static_cast<uint16_t>(first + 0x200 + n));
      require(bits_of(mapping) <= kPdoBits, "a PDO has eight bytes at most");
      const bool on =
          (dictionary.value(static_cast<uint16_t>(first + n), objects::kCobId) & objects::kOff) == 0;
      require(!on || !mapping.empty(), "a PDO that is on carries something");
      for (const Mapped& mapped : mapping) {
        const auto* entry = dictionary.find(mapped.address);
        require(entry != nullptr && mapped.bits == 8 * bytes_of(entry->row->type),
                "what is mapped is an object in its length");
      }
    }
  const uint32_t life_time = dictionary.value(objects::kGuardTime) * dictionary.value(objects::kLifeFactor);
  require(life_time == 0 || (life_time >= 10 && dictionary.value(objects::kProducerHeartbeat) == 0),
          "guarding or heartbeat, and no life time below 10 ms");
}

void check_node(Input input) {
  EventQueue queue(kEvents);
  Wire wire;
  LineWords words;
  wire.words = &words;
  FuzzUnit unit;
  canopen::Node node({queue, 1, wire, 1}, kNumber, *stdlib::find_unit("mdxb"), {}, unit, unit);
  node.start(0);
  size_t requests = 0;
  while (!input.empty()) {
    const Frame frame = frame_from(input);
    require(!words.describe(frame).text.empty(), "a frame has a text");
    requests += frame.id == identifier(Connection::SdoRequest, kNumber);
    node.on_frame(queue.now(), frame);
    check_mapping(node.dictionary());
    unit.words[input.u8() % unit.words.size()] = input.u8();
    node.unit_changed(queue.now());
    queue.run_until(queue.now() + input.u8() * (kMillisecond / 8));
    // The abort of a transfer that was left counts for the request that began it.
    require(wire.sdo <= 2 * requests, "an SDO request has one answer at most, and a transfer one end");
  }
}

void check_client(Input input) {
  SdoClient client;
  const std::vector<uint8_t> data(input.u8() % 32, 0x55);
  if (input.u8() % 2 == 0)
    client.read({0x1008, 0});
  else
    client.write({0x1008, 0}, data);
  while (!input.empty() && client.is_busy()) {
    SdoBytes answer = sdo::initiate(input.u8(), {0x1008, 0}, input.u32());
    if (const auto request = client.take(answer))
      require(client.is_busy() == (sdo::ask_of(*request) != sdo::Ask::Abort), "an abort ends a transfer");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const Input input(data, size);
  check_node(input);
  check_client(input);
  return 0;
}
