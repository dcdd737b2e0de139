// Two masters and two slaves on PROFIBUS with faults of the line, parts that are switched and pulled: the line goes on.
#include <memory>
#include <vector>

#include "runtime/bus/profibus/master.hpp"
#include "runtime/bus/profibus/slave_station.hpp"
#include "tests/fuzz/profibus_unit.hpp"

using namespace ipos::profibus;  // NOLINT
using namespace ipos::tests;     // NOLINT
namespace runtime = ipos::runtime;

namespace {

void check_line(Input input) {
  runtime::EventQueue queue(kEvents);
  const uint32_t baud = kBaudRates[input.u8() % std::size(kBaudRates)].baud;
  Line line(queue, 0, "dp", baud);
  ProfibusUnit units[2];
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
    prm.watchdog_factor_1 = prm.watchdog_factor_2 = 1;  // 10 ms, which a run can reach
    prm.ident = option_type(static_cast<OptionKind>(n)).ident;
    masters[n]->add_slave({static_cast<uint8_t>(10 + n), prm, {0xF0}, 2, 2});
    masters[n]->start();
  }
  OctetFault fault;
  fault.kind = static_cast<OctetFaultKind>(input.u8() % 5);
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
    // A run costs its telegrams, so it goes on for some of them at any baud rate; every eighth step takes up to 4 ms, as
    // the units and the watchdog know milliseconds.
    const uint8_t wait = input.u8();
    const Time until = queue.now() + (wait % 8 == 0 ? wait * (runtime::kMillisecond / 64)
                                                    : wait * (12 * runtime::kSecond / baud));
    for (int events = 0; queue.next_time() <= until; ++events) {
      require(events < 20'000, "time goes on");
      queue.step();
    }
    queue.run_until(until);
  }
  const runtime::LineLoad load = line.load(queue.now());
  require(load.busy_bits <= load.elapsed_bits + 300 * kCharacterBits, "a line is not busier than time");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  check_line({data, size});
  return 0;
}
