// A PC on a bus: asks units over a real port, SBus, CANopen or RS-485, for services of the parameter channel. It is a
// master on a simulated line that is joined to the port, so that pauses, repeats and checks are those of the
// simulated masters.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/movilink/exchange.hpp"
#include "runtime/bus/rs485/line.hpp"
#include "runtime/os_port/bridge.hpp"
#include "runtime/os_port/system_clock.hpp"
#include "tools/parameters/parameter_access.hpp"

namespace ipos::tools {

struct LinkFlags {
  std::string port;           // as in a plant file (docs/guide/ports.md)
  uint32_t baud = 0;          // 0: factory setting, 500000 on SBus, 9600 on RS-485; DP 500000
  bool canopen = false;       // SDO in place of MOVILINK
  bool profibus = false;      // DP in place of MOVILINK on a serial port: dp_station.hpp
  std::string cfg = "F3 F0";  // over DP: identifiers of the configuration with the parameter channel
  bool repeats = true;        // ask a second time after no answer
  bool quiet = false;         // tell nothing about the port unless it goes away
  // How much longer than a unit may take an answer is waited for: the host's share (ours).
  std::string patience = "30ms";

  runtime::Time host_delay() const;
};

class BusLink : private runtime::MovilinkClient {
 public:
  static constexpr const char* kNode = "ipos";  // what it is called on its line

  // Opens the port; a Failure says why it cannot be used.
  static std::unique_ptr<BusLink> open(const LinkFlags& flags);
  virtual ~BusLink() = default;
  BusLink(const BusLink&) = delete;
  BusLink& operator=(const BusLink&) = delete;

  // Waits for the answer. A port that goes away, and Ctrl-C, are Failures.
  AccessReply execute(uint8_t address, stdlib::Service service, uint16_t index, int32_t value);

  // Called before each question of execute(), also before it is asked again; it may ask itself.
  std::function<void()> before_question = [] {};

  // Three words of process output data as a cyclic telegram. False: no answer, or this process slept meanwhile.
  virtual bool carries_process_data() const { return true; }
  bool send_process_data(uint8_t address, const std::array<uint16_t, 3>& words);

  // Serves the port for so long; false: Ctrl-C.
  bool serve(runtime::Time duration);

  runtime::Time now() const { return queue_.now(); }
  // The simulated line, which has what this link sends and what comes over the port; the other one is null.
  virtual runtime::CanLine* can_line() { return nullptr; }
  virtual runtime::Rs485Line* serial_line() { return nullptr; }
  const std::string& port_name() const { return flags_.port; }
  // Addresses of single units.
  virtual bool has_address(int address) const {
    return address >= first_address() && address <= last_address();
  }
  virtual uint8_t first_address() const { return 0; }
  virtual uint8_t last_address() const = 0;

 protected:
  explicit BusLink(LinkFlags flags) : flags_(std::move(flags)) {}

  runtime::EventQueue& queue() { return queue_; }
  runtime::RealClock& clock() { return clock_; }
  runtime::MovilinkClient& client() { return *this; }
  const LinkFlags& flags() const { return flags_; }

 private:
  void on_exchange_done(runtime::Time now, const runtime::MovilinkResult& result) override;
  // Ends also when the clock has gone on by more than a nap between two looks at it.
  runtime::RealTimeLoop::End run(runtime::Time limit, runtime::Time longest_nap = runtime::kNever);
  void tell();

  virtual runtime::MovilinkMaster& master() = 0;
  virtual runtime::Bridge& bridge() = 0;
  virtual uint64_t heard() const = 0;  // frames or bytes that others sent
  // Why there was no answer, as far as the line tells. `heard`: what came over the port meanwhile.
  virtual std::string hint(uint8_t address, uint64_t heard) const = 0;

  LinkFlags flags_;
  runtime::SystemClock clock_;
  runtime::EventQueue queue_;
  std::optional<runtime::MovilinkResult> result_;
};

}  // namespace ipos::tools
