// The bytes of the image as words, and what an embedder has to know of the program: sizes, the parts of ipos.c that it
// needs, variables and functions by name.
#include "tools/build/c_text.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "stdlib/unit_types.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::tools {
namespace {

constexpr uint32_t kKept = 128;  // H0 to H127 are what MEM stores (IPOSplus p. 28)
constexpr size_t kWordsALine = 8;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

// What C accepts as a part of a name.
std::string in_c(std::string_view name) {
  std::string out;
  for (const char c : name) out += is_letter(c) ? c : '_';
  return out;
}

struct Uses {
  bool telegrams = false, interrupts = false, memory = false;
  std::set<std::string> commands;  // that only the host can carry out
};

Uses uses_of(const vm::Image& image) {
  Uses uses;
  for (uint32_t at = 0; at < image.code.size();) {
    const vm::Decoded decoded = vm::decode(image.code, at);
    at += decoded.words;
    switch (decoded.instruction.opcode) {
      case vm::Opcode::Scom:
      case vm::Opcode::ScomOn:
      case vm::Opcode::ScomState: uses.telegrams = true; break;
      case vm::Opcode::SetInt:
      case vm::Opcode::VarInt: uses.interrupts = true; break;
      case vm::Opcode::Memorize: uses.memory = true; break;
      default:
        if (vm::coding(decoded.instruction.opcode).faults == vm::Faults::Host)
          uses.commands.emplace(vm::info(decoded.instruction.opcode).mnemonic());
    }
  }
  return uses;
}

// Names once; one that is taken has the number behind it.
std::string once(std::set<std::string>& names, std::string name, uint32_t number) {
  while (!names.insert(name).second) name += fmt::format("_{}", number);
  return name;
}

}  // namespace

std::string c_text(const vm::Image& image, std::string_view path) {
  const std::string file = std::filesystem::path(path).filename().string();
  std::string name = in_c(std::filesystem::path(path).stem().string());
  if (name.empty() || (name[0] >= '0' && name[0] <= '9')) name.insert(0, "program_");
  const stdlib::UnitType& unit = *stdlib::find_unit(image.unit);
  const std::vector<uint8_t> bytes = vm::write_image(image);
  const Uses uses = uses_of(image);

  std::string out = fmt::format("/* {}, for the unit {}: an image for ipos.h, made by ipos build --emit=c.\n", file, unit.name);
  if (uses.commands.empty()) {
    out += " * It needs nothing of the host's callback `command`.";
  } else {
    out += " * The host's callback `command` is asked for:";
    for (const std::string& command : uses.commands) out += " " + command;
    out += ".";
  }
  out += fmt::format(" */\n#ifndef {0}_IMAGE_H\n#define {0}_IMAGE_H\n\n#include <stddef.h>\n#include <stdint.h>\n\n", name);
  const auto define = [&](const std::string& what, uint32_t value, const std::string& comment) {
    out += fmt::format("#define {}_{} {}{}\n", name, what, value, comment.empty() ? "" : " /* " + comment + " */");
  };
  define("VARIABLES", unit.variables, "H variables of the unit: the least IPOS_VARIABLES");
  define("WORDS", static_cast<uint32_t>(image.code.size()), "code words: the least IPOS_PROGRAM_WORDS");
  define("KEPT_VARIABLES", kKept, "H0 and up are kept in non-volatile memory");
  define("USES_TELEGRAMS", uses.telegrams, "SCOM: the callback `send`, and IPOS_TELEGRAMS");
  define("USES_INTERRUPTS", uses.interrupts, "SETINT, VARINT: IPOS_INTERRUPTS");
  define("USES_MEMORY", uses.memory, "MEM: the callbacks `nv_write` and `nv_read`");

  std::set<std::string> names;
  if (!image.functions.empty()) out += "\n/* Entry points: addresses of functions, for ipos_start_task(). Task 1 begins at 0. */\n";
  for (const vm::FunctionEntry& function : image.functions)
    define(once(names, "ENTRY_" + in_c(function.name), function.address), function.address, "");
  if (!image.symbols.empty()) out += "\n/* Numbers of variables, for ipos_read() and ipos_write(). */\n";
  for (const vm::Symbol& symbol : image.symbols) {
    std::string comment = symbol.count == 1 ? "" : fmt::format("and {} more", symbol.count - 1);
    if (symbol.variable < kKept) comment += comment.empty() ? "kept" : ", kept";
    define(once(names, "H_" + in_c(symbol.name), symbol.variable), symbol.variable, comment);
  }

  out += fmt::format("\n/* {} bytes. Words, as ipos_program_load() wants them aligned. */\n", bytes.size());
  out += fmt::format("static const size_t {}_image_size = {};\nstatic const uint32_t {}_image[] = {{", name, bytes.size(), name);
  for (size_t at = 0; at < bytes.size(); at += 4) {
    uint32_t word = 0;
    for (size_t n = 0; n < 4 && at + n < bytes.size(); ++n) word |= uint32_t{bytes[at + n]} << (8 * n);
    out += fmt::format("{}0x{:08X},", at / 4 % kWordsALine == 0 ? "\n    " : " ", word);
  }
  return out + "\n};\n\n#endif\n";
}

}  // namespace ipos::tools
