// The words of CANopen and PROFIBUS that logs, monitors and journals print: objects, states, aborts, emergencies, services,
// access points, diagnosis bits, answers.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/canopen/emergency.hpp"
#include "runtime/bus/canopen/object_dictionary.hpp"
#include "runtime/bus/profibus/dp_service.hpp"
#include "tools/explain/entries.hpp"

namespace ipos::tools::explain {
namespace {

namespace canopen = runtime::canopen;

void add(Entries& entries, std::vector<std::string> names, std::string title, std::string text) {
  entries.push_back({std::move(names), std::move(title), [text = std::move(text)] { return text; }});
}

std::string_view access_text(canopen::Access access) {
  switch (access) {
    case canopen::Access::Constant: return "constant";
    case canopen::Access::ReadOnly: return "read only";
    case canopen::Access::ReadWrite: return "read and write";
    case canopen::Access::Receive: return "read and write, a receive PDO can carry it";
    case canopen::Access::Transmit: return "read only, a transmit PDO can carry it";
    case canopen::Access::Dummy: return "bits of a receive PDO that are for others";
  }
  return {};
}

// "16 bits, read only, default 0000h".
std::string entry_text(const canopen::EntryRow& row, uint8_t sub) {
  std::string text = row.type == canopen::DataType::VisibleString
                         ? std::string("text")
                         : fmt::format("{} bits", 8 * canopen::bytes_of(row.type));
  text += fmt::format(", {}", access_text(row.access));
  if (canopen::is_writable(row.access) || row.access == canopen::Access::Constant)
    text += fmt::format(", default {:X}h{}", row.default_of(sub), row.own ? " + node" : "");
  return text;
}

std::string object_text(const canopen::ObjectRow& object) {
  std::string text = fmt::format("{:04X}h: object of CANopen, {}\n", object.index, object.name);
  for (const canopen::EntryRow& row : canopen::entry_rows()) {
    if (row.index != object.index) continue;
    for (unsigned n = 0; n < row.subs; ++n) {
      const auto sub = static_cast<uint8_t>(row.sub + n);
      text += fmt::format("  {:04X}h:{} {}: {}\n", object.index, sub,
                          canopen::entry_name({object.index, sub}), entry_text(row, sub));
    }
  }
  return text;
}

void add_canopen(Entries& entries) {
  for (const canopen::ObjectRow& object : canopen::object_rows())
    entries.push_back({{fmt::format("{:04X}h", object.index)},
                       fmt::format("object of CANopen, {}", object.name),
                       [&object] { return object_text(object); }});
  for (const canopen::EntryRow& row : canopen::entry_rows())
    for (unsigned n = 0; n < row.subs; ++n) {
      const auto sub = static_cast<uint8_t>(row.sub + n);
      const std::string name = canopen::entry_name({row.index, sub});
      add(entries, {fmt::format("{:04X}h:{}", row.index, sub)}, fmt::format("object of CANopen, {}", name),
          fmt::format("{:04X}h:{}: object of CANopen, {}\n  {}\n", row.index, sub, name,
                      entry_text(row, sub)));
    }
#define ABORT(name, code, text)                                                    \
  add(entries, {fmt::format("{:08X}h", code)}, fmt::format("SDO abort: {}", text), \
      fmt::format("{:08X}h: abort code of an SDO transfer\n  {}\n", code, text));
#include "runtime/bus/canopen/abort_codes.def"
  for (const canopen::EmergencyRow& row : canopen::kEmergencies)
    add(entries, {fmt::format("{:04X}h", row.code)}, fmt::format("EMCY: {}", row.text),
        fmt::format("{:04X}h: code of a CANopen emergency (EMCY), {}\n  error register {:02X}h{}\n", row.code,
                    row.text, row.error_register, row.status ? ", status word 1 in bytes 4 and 5" : ""));
  add(entries, {"0000h"}, "EMCY: a cause is gone",
      "0000h: code of a CANopen emergency (EMCY): a cause is gone\n");
#define NMT_STATE(name, code, text)                                                                        \
  add(entries, {text, fmt::format("NMT {}", text)}, fmt::format("state of a CANopen node, {:02X}h", code), \
      fmt::format("{}: state of a CANopen node, {:02X}h in the message 700h + node\n", text, code));
#define NMT_COMMAND(name, code, text)                                                                   \
  add(entries, {fmt::format("NMT {}", text)}, fmt::format("command to CANopen nodes, {:02X}h", code),   \
      fmt::format("NMT {}: command to CANopen nodes, {:02X}h and the node in the message 000h\n", text, \
                  code));
#include "runtime/bus/canopen/nmt_commands.def"
  std::map<std::string_view, std::string> messages;  // SDO has two identifiers
  for (const canopen::ConnectionRow& row : canopen::kConnections)
    messages[row.text] += fmt::format("  {:03X}h{}{}\n", row.base, row.addressed ? " + node" : "",
                                      !row.addressed  ? ", for all"
                                      : row.from_node ? ", sent by the node"
                                                      : ", sent to the node");
  for (const auto& [name, identifiers] : messages)
    add(entries, {std::string(name)}, "message of CANopen",
        fmt::format("{}: message of CANopen, with the identifier\n{}", name, identifiers));
}

// Answers are printed with their meaning: "RS: service or access point not available".
std::string short_name(std::string_view text) { return std::string(text.substr(0, text.find(':'))); }

void add_profibus(Entries& entries) {
#define DP_SERVICE(name, access_point, text)                                                              \
  add(entries, {text, fmt::format("SAP {}", access_point), fmt::format("access point {}", access_point)}, \
      fmt::format("service of PROFIBUS-DP, access point {}", access_point),                               \
      fmt::format("{}: service of PROFIBUS-DP, access point {} of the slave; that of the master is {}\n", \
                  text, access_point, profibus::kMasterAccessPoint));
#include "runtime/bus/profibus/dp_services.def"
  add(entries, {"Data_Exchange"}, "service of PROFIBUS-DP, without access point",
      "Data_Exchange: service of PROFIBUS-DP, without access point: outputs to the slave, inputs back\n");
#define DIAG_BIT(name, octet, mask, by, text)                                                                \
  add(entries, {text}, fmt::format("bit of Slave_Diag, octet {}, {:02X}h", octet, mask),                     \
      fmt::format("{}: bit of Slave_Diag, octet {}, mask {:02X}h\n  set by the {}{}\n", text, octet, mask,   \
                  std::string_view(#by) == "Slave" ? "slave" : "master, in its own copy",                    \
                  std::string_view(#name) == "ExtDiag"                                                       \
                      ? "; octets 7 and 8 are 02 and the fault code, of a gateway a bit for each lost drive" \
                      : ""));
#include "runtime/bus/profibus/diag_bits.def"
#define FDL_REQUEST(name, code, text)                                            \
  add(entries, {text}, fmt::format("request of PROFIBUS, function {:X}h", code), \
      fmt::format("{}: request of PROFIBUS (FDL), function {:X}h\n", text, code));
#define FDL_ANSWER(name, code, text)                                                        \
  add(entries, {short_name(text)}, fmt::format("answer of PROFIBUS, function {:X}h", code), \
      fmt::format("{}, answer of PROFIBUS (FDL), function {:X}h\n", text, code));
#include "runtime/bus/profibus/fdl_functions.def"
#define PROFIBUS_OPTION(name, word, unit, ident, fms, set, most_words, model, gsd_file)   \
  add(entries, {fmt::format("{:04X}h", ident)}, fmt::format("ident number of {}", model), \
      fmt::format("{:04X}h: ident number of PROFIBUS, {}, GSD file {}\n", ident, model, gsd_file));
#include "runtime/bus/profibus/options.def"
#define FMS_SERVICE(name, feature, confirmed, number, of_object, text)                                \
  add(entries, {text}, confirmed ? "service of FMS, is answered" : "service of FMS, is not answered", \
      fmt::format("{}: service of FMS, {}\n", text, confirmed ? "is answered" : "is not answered"));
#include "runtime/bus/profibus/fms/services.def"
#define FMS_OBJECT(name, index, length, access, text)                              \
  add(entries, {fmt::format("{}", index)}, fmt::format("object of FMS, {}", text), \
      fmt::format("{}: object of FMS, {}, {} octets\n", index, text, length));
#include "runtime/bus/profibus/fms/objects.def"
}

bool is_hex(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
}

}  // namespace

// As objects, aborts and emergencies are printed: "1017h", "1800h:2", "06020000h".
std::string printed_number(const std::vector<std::string>& words) {
  std::string text = fmt::format("{}", fmt::join(words, ""));
  if (text.starts_with("0x") || text.starts_with("0X")) text.erase(0, 2);
  std::string sub;
  if (const size_t colon = text.find(':'); colon != std::string::npos) {
    sub = text.substr(colon);
    text.erase(colon);
  }
  if (text.ends_with('h') || text.ends_with('H')) text.pop_back();
  const bool by_words = words.size() > 1;  // "06 02 00 00", "0602 0000h"
  const bool marked = words.size() == 1 && text.size() < words[0].size();
  if (!is_hex(text) || (text.size() != 4 && text.size() != 8) || !(marked || by_words)) return {};
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text + "h" + sub;
}

// An object of the unit's parameters: "2070h" is 8304.
std::string parameter_of_object(const std::string& printed) {
  uint32_t index = 0;
  const auto [end, error] = std::from_chars(printed.data(), printed.data() + printed.size(), index, 16);
  if (error != std::errc() || (std::string_view(end, 1) != "h") || printed.size() != 5) return {};
  return index < canopen::objects::kOutput ? std::string() : parameter_of_index(fmt::format("{}", index));
}

void add_fieldbus(Entries& entries) {
  add_canopen(entries);
  add_profibus(entries);
}

}  // namespace ipos::tools::explain
