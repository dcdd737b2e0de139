// The FMS side of the combislave at service level: typed requests over a connection, answers, Abort and Reject
// (MOVITRAC 31 PROFIBUS, 4.1 and 4.3). The octets of FMS on the line are not modelled.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>

#include "runtime/bus/profibus/card.hpp"
#include "runtime/bus/profibus/fms_connection.hpp"
#include "runtime/bus/profibus/fms_objects.hpp"

namespace ipos::profibus {

struct FmsRequest {
  FmsService service = FmsService::Read;
  uint16_t index = 0;
  Octets data;
};

enum class FmsEnd : uint8_t { Positive, Error, Rejected, Aborted };

struct FmsResponse {
  FmsEnd end = FmsEnd::Positive;
  Octets data;                      // of Read and Status
  std::optional<FmsObject> object;  // of Get-OV
  ReturnCode error;                 // class, code and additional of Error
  std::string_view reason;          // of Rejected and Aborted, for people
};

struct FmsIdentity {
  std::string_view vendor = "SEW-Eurodrive GmbH & Co";
  std::string_view model = "MOVITRAC";
  std::string_view revision =
      "821000010";  // 821XXYYZZ, the system software of the inverter; these digits are ours
};

class FmsServer {
 public:
  // Ours: what one service of the inverter takes; the card's own objects answer at once.
  static constexpr Time kProcessing = 10 * runtime::kMillisecond;

  FmsServer(FmsObjects& objects, const OptionType& option) : objects_(objects), option_(option) {}

  // A master opens connection `cref`. On an open connection this ends it: both sides start again.
  FmsResponse initiate(Time now, uint8_t cref, uint8_t master, const FmsMasterEntry& entry);
  void abort(uint8_t cref) { open_.erase(cref); }
  void power_on() { open_.clear(); }

  // What comes at once; nothing: response() has it later.
  std::optional<FmsResponse> request(Time now, uint8_t cref, const FmsRequest& request);
  // The answer of the confirmed service under way, when it is done. Given once.
  std::optional<FmsResponse> response(Time now, uint8_t cref);

  // A watched connection on which nothing came for its time is closed; the slave aborts it. True then.
  bool expire(Time now, uint8_t cref);

  bool is_open(uint8_t cref) const { return open_.count(cref) != 0; }
  bool connected() const { return !open_.empty(); }
  bool busy() const;  // a service is under way: the green LED flickers
  FmsIdentity identity() const { return {}; }

 private:
  struct Pending {
    FmsResponse response;
    Time ready;
  };
  struct Open {
    uint8_t master;
    Time heard;
    std::optional<Pending> pending;
  };

  Pending carry_out(Time now, const FmsRequest& request);

  FmsObjects& objects_;
  const OptionType& option_;
  std::map<uint8_t, Open> open_;
};

}  // namespace ipos::profibus
