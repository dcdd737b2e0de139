// The MOVLNK command of one unit (1053 1610 p. 47 to 49): reads its structure, exchanges over the bus or with
// the unit itself, and stores the result. The calling task waits; the others run on.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/bus/movilink/format.hpp"
#include "runtime/bus/movilink/sbus_master.hpp"
#include "runtime/bus/movilink/sbus_slave.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::runtime {

class MovilinkCommand final : private SbusMasterClient {
 public:
  // `own` and `own_data` serve address 253, the unit itself. Frames are queued at `sender` with `tag`.
  // `bus_type` is the BusType of this line: 5 SBus, on MOVIDRIVE B SBus 1; 8 SBus 2 (IPOSplus p. 309).
  MovilinkCommand(EventQueue& queue, uint32_t source, FrameSender& sender, uint64_t tag, ParameterServer& own,
                  ProcessDataServer& own_data, int32_t bus_type = 5);

  // Begins the exchange of the structure at `variable` for a task. Done: the result is stored already; Wait:
  // the task is resumed when it is. `why` says why an exchange could not be begun.
  vm::HostReply start(Time now, vm::Machine& machine, int task, uint32_t variable, std::string& why);

  void stop();  // program stop: pending exchanges are given up

  // Whom the program has called over the line, for tools: address as in MOVLNK, and what was exchanged.
  struct Partner {
    int32_t address;
    bool parameter;
    bool process_data;
  };
  const std::vector<Partner>& partners() const { return partners_; }
  // The command of this structure was carried out.
  bool has_called(uint32_t variable) const;

  bool on_frame(Time now, const Frame& frame) { return master_.on_frame(now, frame); }
  void on_sent(Time now, uint64_t tag) { master_.on_sent(now, tag); }

 private:
  struct Job {
    vm::Machine* machine;
    int task;
    uint32_t variable;  // of the structure
    uint32_t data;      // of MLDATA
    SbusJob bus;
  };

  void on_exchange_done(Time now, const SbusResult& result) override;
  void begin_next(Time now);
  SbusResult serve_own(Time now, const SbusJob& job, TelegramFormat format);
  void remember_partner(int32_t address, TelegramFormat format);
  static void store(const Job& job, const SbusResult& result);

  ParameterServer& own_;
  ProcessDataServer& own_data_;
  SbusMaster master_;
  int32_t bus_type_;
  std::vector<Partner> partners_;
  std::vector<uint32_t> structures_;  // of commands carried out
  std::vector<Job> jobs_;             // the first one is on the bus, the others wait for it
};

}  // namespace ipos::runtime
