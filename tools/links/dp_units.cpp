// Slave_Diag, Get_Cfg, RD_Inputs and RD_Outputs in words; parameters by data exchange.
#include "tools/links/dp_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "runtime/bus/movilink/parameter_telegram.hpp"
#include "runtime/bus/profibus/card.hpp"
#include "runtime/bus/profibus/cfg_data.hpp"
#include "runtime/bus/profibus/fieldbus_parameters.hpp"
#include "runtime/bus/profibus/frame_text.hpp"
#include "runtime/plant_file/bytes_text.hpp"
#include "stdlib/faults.hpp"
#include "stdlib/parameters.hpp"
#include "tools/cli/failure.hpp"

namespace ipos::tools {
namespace {

using namespace profibus;  // NOLINT: all of this is about its services
using runtime::ParameterTelegram;
using stdlib::ReturnCode;
using stdlib::Service;

constexpr size_t kChannel = 8;                             // octets
constexpr runtime::Time kPatience = 2 * runtime::kSecond;  // until a service of the channel is done (ours)
// The watchdog gives the slave free where this program is killed: 5 s (ours; a busy host must not lose it).
constexpr uint8_t kWatchdogFactors[] = {100, 5};

const OptionType* type_of(uint16_t ident) {
  for (const OptionType& type : option_types())
    if (type.ident == ident) return &type;
  return nullptr;
}

std::string state_of(const Diagnosis& told) {
  const std::string master = told.master == kNoMaster ? "no master" : fmt::format("master {}", told.master);
  if (told.has(diag::kPrmReq)) return "waits for Set_Prm";
  if (told.has(diag::kNotReady)) return "waits for Chk_Cfg of " + master;
  return "data exchange with " + master;
}

// The bits that say more than the state.
std::string diagnosis_of(const Diagnosis& told) {
  Diagnosis rest = told;
  for (const DiagBit bit : {diag::kPrmReq, diag::kNotReady, diag::kAlwaysOne}) rest.set(bit, false);
  rest.fault.reset();
  const std::string words = profibus::describe(rest);
  std::string text = words.substr(0, words.find("; master"));
  if (text == "ready") text.clear();
  if (told.fault) {
    const stdlib::FaultRow* row = stdlib::find_fault(*told.fault);
    text +=
        fmt::format("{}F{:02} {}", text.empty() ? "" : ", ", *told.fault, row ? row->name : "unknown fault");
  }
  return text.empty() ? "-" : text;
}

constexpr std::string_view kUnitWithBcd = "mc31";  // whose configurations, indices and values are known here

std::string configuration_of(const DpReply& reply, const OptionType* type) {
  if (!reply.answered || reply.refused) return "-";
  const bool has_names = type != nullptr && type->unit == kUnitWithBcd;
  const Configuration* known = has_names ? find_configuration(reply.data) : nullptr;
  return profibus::hex_text(reply.data) + (known ? fmt::format(" ({})", known->name) : "");
}

std::string octets_of(const DpReply& reply) {
  return reply.answered && !reply.refused ? profibus::hex_text(reply.data) : "-";
}

std::string kind_text(StationKind kind) {
  switch (kind) {
    case StationKind::Slave: return "slave";
    case StationKind::MasterNotReady: return "master, not ready for the ring";
    case StationKind::MasterReady: return "master, ready for the ring";
    case StationKind::MasterInRing: return "master in the ring";
  }
  return "";
}

// The channel in the cyclic data.
class DpAccess final : public ParameterAccess {
 public:
  DpAccess(const LinkFlags& flags, uint8_t address) : line_(flags), address_(address) {
    const Octets cfg = cfg_of(flags.cfg);
    lock(cfg);
    outputs_.resize(find_configuration(cfg)->octets);
    // The bit of the handshake begins where the slave has it not: a service "none" brings both to 0.
    if (auto begun = run({}); !begun && !begun.error().code)
      throw Failure(kIoError, place(begun.error().trouble));
  }
  ~DpAccess() override {
    if (!locked_) return;
    PrmData unlock;
    unlock.unlock = true;
    try {
      line_.service(address_, DpService::SetPrm, encode(unlock));
    } catch (const Failure&) {  // the port has gone, or Ctrl-C: the watchdog gives the slave free
    }
  }
  DpAccess(const DpAccess&) = delete;
  DpAccess& operator=(const DpAccess&) = delete;

  AccessReply execute(Service service, uint16_t index, int32_t value) override {
    const stdlib::Parameter* parameter = stdlib::parameter_table(*unit_).find(index);
    const bool bcd = parameter != nullptr && parameter->bcd;
    auto data = static_cast<uint32_t>(value);
    if (stdlib::is_write(service) && bcd) {
      const auto digits = to_bcd(value);
      if (!digits)
        return tl::unexpected(AccessError{{}, fmt::format("{} has no form of eight decimal digits", value)});
      data = *digits;
    }
    handshake_ = !handshake_;
    const auto fieldbus_index = static_cast<uint16_t>(index + kFirstParameterIndex);
    ParameterTelegram request =
        runtime::parameter_request(service, fieldbus_index, 0, static_cast<int32_t>(data));
    if (handshake_) request.management |= runtime::management::kHandshake;
    const auto answer = run(request);
    if (!answer) return tl::unexpected(answer.error());
    if (stdlib::is_write(service)) return value;
    if (!bcd) return static_cast<int32_t>(*answer);
    if (const auto decimal = from_bcd(*answer)) return *decimal;
    return tl::unexpected(AccessError{{}, fmt::format("{:08X}h are no decimal digits", *answer)});
  }
  std::string name() const override { return fmt::format("unit {} at {}", address_, line_.port_name()); }
  const stdlib::UnitType& unit() const override { return *unit_; }

 private:
  std::string place(const std::string& text) const { return name() + ": " + text; }

  Octets cfg_of(const std::string& text) const {
    const auto cfg = runtime::parse_bytes(text);
    if (!cfg)
      throw Failure(kUsage, fmt::format("--cfg '{}': write identifier octets such as \"F3 F0\"", text));
    const Configuration* known = find_configuration(*cfg);
    if (known != nullptr && !known->parameter_channel)
      throw Failure(kUsage, fmt::format("--cfg '{}': {} has no parameter channel; take F3 F0, F3 F1 or F3 F2",
                                        text, known->name));
    return *cfg;
  }

  Diagnosis ask_diagnosis() {
    const DpReply reply = line_.service(address_, DpService::SlaveDiag);
    if (!reply.answered)
      throw Failure(
          kIoError,
          place(line_.heard_anything()
                    ? fmt::format("no answer, though others are heard: is P073 = {} anywhere?", address_)
                    : fmt::format("no answer: unit on, address P073 = {}, {} baud, A and B not exchanged?",
                                  address_, line_.baud())));
    const auto told = reply.refused ? std::nullopt : decode_diagnosis(reply.data);
    if (!told) throw Failure(kIoError, place("what it answers is no diagnosis: no DP slave?"));
    return *told;
  }

  void lock(const Octets& cfg) {
    const Diagnosis before = ask_diagnosis();
    const OptionType* type = type_of(before.ident);
    if (type == nullptr)
      throw Failure(kFindings,
                    place(fmt::format("ident number {:04X}h: no unit that is known here", before.ident)));
    if (type->unit != kUnitWithBcd)
      throw Failure(kFindings,
                    place(fmt::format("{}: over PROFIBUS this verb reaches MOVITRAC 31 only", type->model)));
    unit_ = stdlib::find_unit(type->unit);
    if (before.master != kNoMaster && before.master != kPcAddress)
      throw Failure(kFindings,
                    place(fmt::format(
                        "master {} has locked it ({}): the parameter channel lies in its cyclic data; stop "
                        "that master, and let it unlock the slave or the watchdog run out",
                        before.master, state_of(before))));
    PrmData prm;
    prm.lock = prm.watchdog = true;
    prm.watchdog_factor_1 = kWatchdogFactors[0];
    prm.watchdog_factor_2 = kWatchdogFactors[1];
    prm.min_tsdr = kLeastMinTsdr;
    prm.ident = before.ident;
    const DpReply parameterised = line_.service(address_, DpService::SetPrm, encode(prm));
    if (parameterised.refused)
      throw Failure(kFindings, place("refuses Set_Prm: another master has locked it meanwhile"));
    locked_ = true;
    line_.service(address_, DpService::ChkCfg, cfg);
    const Diagnosis after = ask_diagnosis();
    if (after.has(diag::kCfgFault))
      throw Failure(kFindings, place(fmt::format(
                                   "refuses the configuration {} (Cfg_Fault); a MOVITRAC 31 takes 2, 4, 6, "
                                   "10, 12 or 14 octets in each direction",
                                   profibus::hex_text(cfg))));
    if (after.has(diag::kPrmFault) || after.has(diag::kPrmReq) || after.has(diag::kNotReady))
      throw Failure(kFindings, place("does not begin the data exchange: " + profibus::describe(after)));
  }

  // Exchanges until the slave has followed the handshake: four octets, or why not.
  tl::expected<uint32_t, AccessError> run(const ParameterTelegram& request) {
    const runtime::ParameterBytes bytes = runtime::encode(request);
    std::copy(bytes.begin(), bytes.end(), outputs_.begin());
    const runtime::Time end = line_.now() + kPatience;
    do {
      const DpReply reply = line_.exchange(address_, outputs_);
      if (!reply.answered) return tl::unexpected(AccessError{{}, "no answer to a Data_Exchange"});
      if (reply.refused || reply.data.size() != outputs_.size()) {
        locked_ = false;
        return tl::unexpected(AccessError{{}, "it has left the data exchange"});
      }
      runtime::ParameterBytes came{};
      std::copy_n(reply.data.begin(), kChannel, came.begin());
      const ParameterTelegram answer = runtime::decode_parameter(came);
      if (answer.synchronous() != request.synchronous()) continue;
      if (answer.failed()) return tl::unexpected(AccessError{answer.return_code(), {}});
      return answer.data;
    } while (line_.now() < end);
    return tl::unexpected(AccessError{{}, "the service in the parameter channel does not end"});
  }

  DpStation line_;
  uint8_t address_;
  const stdlib::UnitType* unit_ = nullptr;
  bool locked_ = false;
  bool handshake_ = false;
  Octets outputs_;  // the channel, then process data words of 0
};

}  // namespace

std::vector<std::string> dp_scan_heads() {
  return {"address", "unit", "ident", "configuration", "state", "diagnosis", "inputs", "outputs"};
}

std::optional<std::vector<std::string>> dp_scan_row(DpStation& line, uint8_t address) {
  const auto kind = line.status(address);
  if (!kind) return std::nullopt;
  std::vector<std::string> row{std::to_string(address), kind_text(*kind), "-", "-", "-", "-", "-", "-"};
  if (*kind != StationKind::Slave) return row;
  const DpReply diagnosis = line.service(address, DpService::SlaveDiag);
  const auto told = diagnosis.refused ? std::nullopt : decode_diagnosis(diagnosis.data);
  if (!told) return row;
  const OptionType* type = type_of(told->ident);
  if (type != nullptr) row[1] = std::string(type->model);
  row[2] = fmt::format("{:04X}h", told->ident);
  row[3] = configuration_of(line.service(address, DpService::GetCfg), type);
  row[4] = state_of(*told);
  row[5] = diagnosis_of(*told);
  if (told->has(diag::kNotReady) || told->has(diag::kPrmReq)) return row;
  row[6] = octets_of(line.service(address, DpService::ReadInputs));
  row[7] = octets_of(line.service(address, DpService::ReadOutputs));
  return row;
}

std::unique_ptr<ParameterAccess> open_dp_unit(const LinkFlags& flags, uint8_t address) {
  return std::make_unique<DpAccess>(flags, address);
}

}  // namespace ipos::tools
