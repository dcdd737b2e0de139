// Any sequence of frames to a slave on PROFIBUS: it answers once and only what is for it, and its unit gets outputs only
// in data exchange and of the configured length.
#include "runtime/bus/profibus/frame_text.hpp"
#include "tests/fuzz/profibus_unit.hpp"

using namespace ipos::profibus;  // NOLINT
using namespace ipos::tests;     // NOLINT
namespace runtime = ipos::runtime;

namespace {

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
  ProfibusUnit unit;
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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  check_slave({data, size});
  return 0;
}
