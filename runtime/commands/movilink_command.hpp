// The MOVLNK command of one unit (1053 1610 p. 47 to 49): reads its structure, exchanges over the bus it
// names or with the unit itself, and stores the result. The calling task waits; the others run on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/movilink/exchange.hpp"
#include "runtime/bus/movilink/unit_servers.hpp"
#include "runtime/journal/journal.hpp"
#include "stdlib/unit_types.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::runtime {

// BusType of MOVLNK (1053 1610 p. 47).
enum class MovilinkBus : uint8_t {
#define MOVILINK_BUS(name, code, units, text) name,
#include "stdlib/movilink_buses.def"
};
inline constexpr size_t kMovilinkBuses = static_cast<size_t>(MovilinkBus::Canopen) + 1;

class MovilinkCommand final {
 public:
  // `own` and `own_data` serve address 253, the unit itself. Exchanges without an answer are told to the
  // journal.
  MovilinkCommand(const stdlib::UnitType& unit, ParameterServer& own, ProcessDataServer& own_data,
                  Journal& journal, std::string_view station);

  // The class that carries the exchanges of a bus reports to client(bus). A bus without master is not connected.
  MovilinkClient& client(MovilinkBus bus) { return routes_[static_cast<size_t>(bus)]; }
  void connect(MovilinkBus bus, MovilinkMaster& master) {
    routes_[static_cast<size_t>(bus)].master = &master;
  }
  void disconnect(MovilinkBus bus) { routes_[static_cast<size_t>(bus)].master = nullptr; }

  // Begins the exchange of the structure at `variable` for a context. Done: the result is stored already;
  // Wait: the context is resumed when it is. `why` says why an exchange could not be begun.
  vm::HostReply start(Time now, vm::Machine& machine, int context, uint32_t variable, std::string& why);

  // Power-on. `tells_early`: who asks a partner at once hears that a real one would not be ready.
  void power_on(Time now, bool tells_early) {
    begun_ = now;
    tells_early_ = tells_early;
  }
  void stop();  // program stop: pending exchanges are given up

  // The context that waits for an exchange was stopped: the exchange ends on the bus, but nobody takes its
  // result any more (ours).
  void give_up(const vm::Machine& machine, int context);

  // Whom the program has called over a bus, for tools: address as in MOVLNK, and what was exchanged.
  struct Partner {
    int32_t address;
    bool parameter;
    bool process_data;
  };
  const std::vector<Partner>& partners(MovilinkBus bus) const {
    return routes_[static_cast<size_t>(bus)].partners;
  }
  // The command of this structure was carried out.
  bool has_called(uint32_t variable) const;

 private:
  struct Job {
    vm::Machine* machine;  // null: nobody waits any more
    int context;
    uint32_t variable;  // of the structure
    uint32_t data;      // of MLDATA
    MovilinkJob bus;
  };
  // One bus: the first job is on it, the others wait.
  struct Route final : MovilinkClient {
    void on_exchange_done(Time now, const MovilinkResult& result) override;
    void begin_next(Time now);
    void remember_partner(int32_t address, TelegramFormat format);

    MovilinkCommand* command = nullptr;
    MovilinkMaster* master = nullptr;
    std::vector<Job> jobs;
    std::vector<Partner> partners;
  };

  std::string unknown_bus(int32_t code) const;
  MovilinkResult serve_own(Time now, const MovilinkJob& job, TelegramFormat format);
  static void store(const Job& job, const MovilinkResult& result);
  static void finish(const Job& job, const MovilinkResult& result);

  const stdlib::UnitType& unit_;
  ParameterServer& own_;
  ProcessDataServer& own_data_;
  Journal& journal_;
  std::string station_;
  std::array<Route, kMovilinkBuses> routes_;
  std::vector<uint32_t> structures_;  // of commands carried out
  Time begun_ = 0;
  bool tells_early_ = false;
};

}  // namespace ipos::runtime
