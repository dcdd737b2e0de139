// Compiling and loading for the verbs.
#include "tools/input/program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "compiler/ast/print.hpp"
#include "compiler/compile.hpp"
#include "compiler/diag/once.hpp"
#include "compiler/diag/places.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/sema/map.hpp"
#include "runtime/signals/find.hpp"
#include "runtime/station/station.hpp"
#include "runtime/unit/program_image.hpp"
#include "stdlib/headers.hpp"
#include "stdlib/unit_names.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/terminal.hpp"
#include "tools/cli/text_lines.hpp"
#include "tools/input/offers.hpp"
#include "tools/input/sources.hpp"

namespace ipos::tools {
namespace {

const stdlib::UnitType* unit_of(const CompileFlags& flags) {
  if (flags.unit.empty()) return nullptr;
  const stdlib::UnitType* unit = stdlib::find_unit_or_plate(flags.unit);
  if (unit == nullptr || !unit->runs_programs())
    throw Failure(kUsage, fmt::format("'{}' is no unit type with IPOS; known are {}", flags.unit,
                                      stdlib::program_unit_names()));
  return unit;
}

std::string read_main(const std::string& path, const CompileFlags& flags) {
  std::string text = read_file(path);
  if (flags.record != nullptr)
    flags.record->texts[path] = text;
  else
    keep_source(path, text);
  return text;
}

void tell(const compiler::Compilation& compiled, const CompileFlags& flags) {
  if (flags.record == nullptr) return print_diagnostics(*compiled.sources, compiled.diagnostics, flags.diagnostics);
  for (const compiler::Diagnostic& one : compiler::each_once(compiled.diagnostics.all(), *compiled.sources)) {
    Told message{std::string(compiler::severity_word(one.severity)), "", 0, 0, one.text,
                 std::string(compiler::info(one.diag).code)};
    if (one.span.begin.valid()) {
      const compiler::Position begin = compiler::range_of(one.span, *compiled.sources).begin;
      message.file = begin.file->path.empty() ? begin.file->name : begin.file->path;
      message.line = begin.line;
      message.column = begin.column;
    }
    flags.record->tell(std::move(message));
  }
}

// Compiles and prints the messages.
compiler::Compilation compile(const std::string& path, const CompileFlags& flags) {
  compiler::CompileOptions options = options_of(flags);
  compiler::Compilation result = compiler::compile(path, path, read_main(path, flags), options);
  tell(result, flags);
  return result;
}

// Source lines for the listing.
compiler::SourceLines source_lines(const vm::Image& image) {
  auto texts = std::make_shared<std::map<size_t, std::vector<std::string>>>();
  return [&image, texts](size_t file, uint32_t line) -> std::optional<std::string_view> {
    auto [entry, is_new] = texts->try_emplace(file);
    if (is_new)
      for (const std::string& one : text_lines(source_text(image.files[file]).value_or("")))
        entry->second.push_back(compiler::printable(one));
    const std::vector<std::string>& lines = entry->second;
    if (line == 0 || line > lines.size()) return std::nullopt;
    return lines[line - 1];
  };
}

std::string commands_of(vm::Image code) {
  code.symbols.clear();  // `ipos disasm` has the symbols and lines, too
  code.files.clear();
  code.lines.clear();
  return compiler::disassemble(code);
}

}  // namespace

void BuildRecord::tell(Told message) {
  if (std::find(messages.begin(), messages.end(), message) == messages.end()) messages.push_back(std::move(message));
}

void add_compile_options(cli::Verb& verb, CompileFlags& flags) {
  verb.option("-I", flags.include_dirs, "folder for #include").one_each();
  verb.option("-D", flags.defines, "NAME=VALUE, as #define").one_each();
  verb.option("-W", flags.warnings, "warning by name: -Wunused-variable, -Wno-..., -Werror").one_each();
  verb.option("--unit", flags.unit, "unit type: " + stdlib::program_unit_names()).offers([](const auto&) {
    return offered_units();
  });
  verb.flag("--atomic", flags.atomic, "variables that others see never hold intermediate results");
  verb.option("-O", flags.optimization, "0: commands as the source is written; 1: forms with fewer commands, where nobody sees it").one_of({"0", "1"});
  verb.option("--diagnostics", flags.diagnostics, "text, json or sarif").one_of({"text", "json", "sarif"});
}

void add_plant_options(cli::Verb& verb, CompileFlags& flags) {
  add_compile_options(verb, flags);
  verb.flag("--allow-fmu", flags.allow_fmu, "let the FMUs run that are machines of the plant; they are programs of others");
}

compiler::CompileOptions options_of(const CompileFlags& flags) {
  compiler::CompileOptions options;
  options.include_dirs = flags.include_dirs;
  options.defines = flags.defines;
  options.read_file = read_source;
  if (flags.record != nullptr)
    options.read_file = [record = flags.record](const std::string& path) {
      std::optional<std::string> text = try_read_file(path);
      if (text) record->texts[path] = *text;
      return text;
    };
  options.list_files = list_files;
  options.unit = unit_of(flags);
  options.atomic = flags.atomic;
  options.as_written = flags.optimization == "0";
  options.is_unit_value = signals::is_unit_value;
  for (const std::string& warning : flags.warnings)
    if (!options.warnings.apply(warning))
      throw Failure(kUsage, fmt::format("there is no warning -W{}", warning));
  return options;
}

bool is_source(std::string_view path) {
  if (path.size() < 4) return false;
  std::string ending(path.substr(path.size() - 4));
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  return ending == ".IPC";
}

void print_diagnostics(const compiler::SourceMap& sources, const compiler::Diagnostics& diagnostics,
                       const std::string& form) {
  const auto all = compiler::each_once(diagnostics.all(), sources);
  if (form == "json") {
    fmt::print(stderr, "{}", compiler::render_json(all, sources));
  } else if (form == "sarif") {
    fmt::print(stderr, "{}", compiler::render_sarif(all, sources));
  } else {
    fmt::print(stderr, "{}", compiler::render_text(all, sources, has_colours(STDERR_FILENO)));
  }
}

vm::Image compile_file(const std::string& path, const CompileFlags& flags) {
  compiler::Compilation result = compile(path, flags);
  if (!result.image) throw Failure(kBadInput, "");
  return std::move(*result.image);
}

std::vector<std::string> included_files(const std::string& path, const CompileFlags& flags) {
  compiler::SourceMap sources;
  compiler::Diagnostics ignored;
  const compiler::SourceFile& main = sources.add(path, path, read_file(path));
  compiler::PreprocessOptions options;
  options.headers = stdlib::built_in_files();
  options.include_dirs = flags.include_dirs;
  options.defines = flags.defines;
  options.read_file = try_read_file;
  std::vector<std::string> files;
  for (const auto& include : compiler::preprocess(sources, main, options, ignored).record.includes)
    if (!include.file->path.empty()) files.push_back(include.file->path);
  return files;
}

vm::Image load_image(const std::string& path) {
  const std::string bytes = read_file(path);
  auto image = runtime::read_program_image({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
  if (!image) throw Failure(kFindings, fmt::format("{}: image {}", path, image.error()));
  return *std::move(image);
}

vm::Image load_program(const std::string& path, const CompileFlags& flags) {
  return is_source(path) ? compile_file(path, flags) : load_image(path);
}

std::string emit_stage(const std::string& path, const CompileFlags& flags, const std::string& stage) {
  if (stage == "tokens" || stage == "ast") {
    const compiler::CompileOptions options = options_of(flags);
    compiler::SourceMap sources;
    compiler::Diagnostics diagnostics(options.warnings);
    const compiler::SourceFile& main = sources.add(path, path, read_file(path));
    const compiler::PreprocessOptions preprocessing{options.include_dirs, options.defines,
                                                    stdlib::built_in_files(), options.read_file,
                                                    options.list_files};
    const std::string text =
        stage == "tokens"
            ? compiler::print_tokens(sources, main,
                                     compiler::preprocess(sources, main, preprocessing, diagnostics))
            : compiler::ast::print(compiler::parse_program(sources, main, preprocessing, diagnostics),
                                   sources);
    print_diagnostics(sources, diagnostics, flags.diagnostics);
    if (diagnostics.has_errors()) throw Failure(kBadInput, "");
    return text;
  }
  const compiler::Compilation result = compile(path, flags);
  // A listing shows where the words of a program go that is too long.
  const std::optional<vm::Image>& image = result.image ? result.image : result.too_long;
  if (!image) throw Failure(kBadInput, "");
  const std::string text = stage == "map"       ? compiler::map_text(result.map)
                           : stage == "listing" ? program_listing(*image, compiler::VariableNames::Numbers)
                                                : commands_of(*image);
  if (result.image) return text;
  fmt::print("{}", text);
  throw Failure(kBadInput, "");
}

std::string program_listing(const vm::Image& image, compiler::VariableNames names) {
  return compiler::listing(image, source_lines(image), names);
}

std::string dump_image(const vm::Image& image) {
  const stdlib::UnitType* unit = stdlib::find_unit(image.unit);
  std::string text = fmt::format("unit {} ({})\n\ncode, {} words\n", image.unit,
                                 unit == nullptr ? "unknown" : unit->name, image.code.size());
  for (size_t n = 0; n < image.code.size(); ++n)
    text += fmt::format("{}{:08X}{}", n % 8 == 0 ? fmt::format("{:5}  ", n) : "", image.code[n],
                        n % 8 == 7 || n + 1 == image.code.size() ? "\n" : " ");
  text += fmt::format("\nsymbols, {}\n", image.symbols.size());
  for (const vm::Symbol& symbol : image.symbols)
    text += fmt::format("{:<5} {}{}\n", fmt::format("H{}", symbol.variable), symbol.name,
                        symbol.count == 1 ? "" : fmt::format("[{}]", symbol.count));
  text += fmt::format("\nfunctions, {}\n", image.functions.size());
  for (const vm::FunctionEntry& function : image.functions)
    text += fmt::format("{:5}  {}\n", function.address, function.name);
  text += fmt::format("\nlines, {}\n", image.lines.size());
  for (const vm::LineEntry& line : image.lines)
    text += fmt::format("{:5}  {}:{}:{}\n", line.address, image.files[line.file], line.line, line.column);
  return text;
}

bool verify_image(const std::string& file, const vm::Image& image) {
  const std::string path = compiler::printable(file);
  const stdlib::UnitType* unit = stdlib::find_unit(image.unit);
  if (unit == nullptr || unit->tasks == 0) {
    fmt::print(stderr, "{}: error: unit type {} runs no program\n", path, image.unit);
    return false;
  }
  std::array<vm::Violation, 20> violations{};
  const vm::Verification result = vm::verify(image.code, runtime::limits_of(*unit), violations);
  const size_t shown = std::min<size_t>(result.violations, violations.size());
  for (size_t n = 0; n < shown; ++n) {
    const vm::RuleInfo& rule = vm::info(violations[n].rule);
    fmt::print(stderr, "{}: error: word {}: {} [{}]\n", path, violations[n].address, rule.meaning, rule.code);
  }
  if (result.violations > shown) fmt::print(stderr, "{}: and {} more\n", path, result.violations - shown);
  return result.violations == 0;
}

}  // namespace ipos::tools
