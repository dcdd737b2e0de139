// ipos bus dissector: the Lua dissector for Wireshark, with the tables of this project and, with a plant, what
// its stations, words and variables are called.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "runtime/bus/movilink/identifiers.hpp"
#include "runtime/bus/movilink/process_words.hpp"
#include "stdlib/embedded.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/return_codes.hpp"
#include "stdlib/services.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/outputs.hpp"

namespace ipos::tools {
namespace wireshark {
std::span<const stdlib::EmbeddedFile> embedded_files();
}

namespace {

using runtime::UnitNames;


// A text of Lua; bytes that are not printable are written by their number.
std::string lua_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (byte < 0x20 || byte == 0x7F)
      out += fmt::format("\\{:03}", byte);
    else
      out += c;
  }
  return out + '"';
}

std::string services() {
  return "local services = {"
#define SERVICE(name, code, text) "[" #code "] = \"" text "\", "
#include "stdlib/services.def"
         "}\n";
}

std::string return_codes() {
  std::string classes = "local classes = {", errors = "local errors = {";
#define RETURN_CLASS(error_class, meaning) \
  classes += fmt::format("[{}] = {}, ", error_class, lua_text(meaning));
#define RETURN_CODE(name, error_class, code, additional, meaning)                                           \
  errors +=                                                                                                 \
      fmt::format("[{}] = {}, ", uint32_t{error_class} << 24 | uint32_t{code} << 16 | uint32_t{additional}, \
                  lua_text(meaning));
#include "stdlib/return_codes.def"
  return classes + "}\n" + errors + "}\n";
}

// By function, parameter telegrams 8 further.
std::string telegrams() {
  std::string text = "local telegrams = {\n";
  for (const runtime::TelegramType& type : runtime::kTelegrams)
    text += fmt::format("  [{}] = {{text = {}, parameter = {}, grouped = {}, from_master = {}}},\n",
                        type.function + (type.parameter ? 8 : 0), lua_text(type.text), type.parameter,
                        type.grouped, type.from_master);
  return text + "}\n";
}

std::string words(const stdlib::UnitType& unit, bool input) {
  const char* kind = input ? "pi" : "po";
  std::string names = fmt::format("local {}_names = {{", kind),
              scales = fmt::format("local {}_scales = {{", kind);
  for (uint8_t code = 1; code < 32; ++code) {
    const std::string_view name = runtime::process_word_name(unit, input, code);
    if (name.empty()) continue;
    names += fmt::format("[{}] = {}, ", code, lua_text(name));
    const runtime::ProcessWordScale scale = runtime::process_word_scale(input, code);
    scales += fmt::format("[{}] = {{signed = {}, numerator = {}, denominator = {}, unit = {}}}, ", code,
                          scale.is_signed, scale.numerator, scale.denominator, lua_text(scale.unit));
  }
  return names + "}\n" + scales + "}\n";
}

std::string parameters(const std::set<const stdlib::UnitType*>& types) {
  std::string text = "local parameters = {\n";
  for (const stdlib::UnitType* type : types) {
    text += fmt::format("  {} = {{", type->name);
    for (const stdlib::Parameter* row : stdlib::parameter_table(*type).by_index())
      text += fmt::format("[{}] = {}, ", row->index, lua_text(row->name));
    text += "},\n";
  }
  return text + "}\n";
}

std::string unit_row(const UnitNames& unit) {
  std::string text = fmt::format("{{name = {}, po = {{{}}}, pi = {{{}}}", lua_text(unit.name),
                                 fmt::join(unit.output, ", "), fmt::join(unit.input, ", "));
  if (unit.unit != nullptr)
    text += fmt::format(", type = {}, variables = {}", lua_text(unit.unit->name), unit.unit->variables);
  text += ", variable_names = {";
  for (const runtime::VariableName& row : unit.variables)
    text += fmt::format("[{}] = {}, ", row.number, lua_text(row.name));
  return text + "}}";
}

std::string units(const char* table, const runtime::TelegramNames& names, bool by_group) {
  std::string text = fmt::format("local {} = {{\n", table);
  std::set<unsigned> seen;
  for (const UnitNames& unit : names.units) {
    const unsigned number = by_group ? unit.settings.group : unit.settings.address;
    if (seen.insert(number).second) text += fmt::format("  [{}] = {},\n", number, unit_row(unit));
  }
  return text + "}\n";
}

// DPointer carries the low-order bytes, the next variable those beyond the fourth; Motorola has these in front.
std::string objects(const runtime::TelegramNames& names) {
  std::string text = "local objects = {\n";
  std::set<uint32_t> seen;
  for (const runtime::ObjectNames& row : names.objects) {
    const runtime::ObjectNames& object = *names.object(row.id);  // the sender's names win
    if (!seen.insert(object.id).second) continue;
    const bool little = object.format.layout == runtime::VariableLayout::Intel;
    const unsigned length = object.format.length, low = std::min(length, 4U), high = length - low;
    text += fmt::format("  [{}] = {{station = {}, little = {}, parts = {{", object.id,
                        lua_text(object.station), little);
    if (low != 0)
      text += fmt::format("{{name = {}, offset = {}, size = {}}}, ", lua_text(object.variables[0]),
                          little ? 0 : high, low);
    if (high != 0)
      text += fmt::format("{{name = {}, offset = {}, size = {}}}", lua_text(object.variables[1]),
                          little ? 4 : 0, high);
    text += "}},\n";
  }
  return text + "}\n";
}

std::string dissector(const runtime::TelegramNames& sbus, const runtime::TelegramNames& serial) {
  const stdlib::UnitType& usual = stdlib::usual_unit();
  std::set<const stdlib::UnitType*> types{&usual};
  for (const auto* names : {&sbus, &serial})
    for (const UnitNames& unit : names->units)
      if (unit.unit != nullptr) types.insert(unit.unit);
  std::string text = services() + return_codes() + telegrams() + words(usual, false) + words(usual, true) +
                     parameters(types);
  text +=
      fmt::format("local default_type, default_variables = {}, {}\n", lua_text(usual.name), usual.variables);
  text += units("units", sbus, false) + units("groups", sbus, true) + units("serial_units", serial, false) +
          objects(sbus);
  return text + std::string(wireshark::embedded_files().front().text);
}

}  // namespace

void add_bus_dissector(cli::Verb& bus) {
  struct Flags {
    std::string plant;
    std::string out = "-";
    CompileFlags compile;
  };
  auto flags = std::make_shared<Flags>();
  cli::Verb& verb = bus.verb("dissector", "write a dissector for Wireshark, in Lua");
  verb.option("PLANT", flags->plant, "plant or program whose stations, words and variables are named");
  verb.option("-o", flags->out, "file to write; - is standard output");
  add_compile_options(verb, flags->compile);
  verb.footer(
      "Example:\n  ipos bus dissector examples/scom/scom.toml -o "
      "~/.local/lib/wireshark/plugins/movilink.lua");
  verb.runs([flags] {
    const runtime::BusNames names = bus_names_of(flags->plant, flags->compile);
    replace_file(flags->out, dissector(names.can.all.movilink, names.serial));
    return kGood;
  });
}

}  // namespace ipos::tools
