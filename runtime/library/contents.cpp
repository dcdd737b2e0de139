// Reading and compiling without a word on the terminal.
#include "runtime/library/contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "compiler/compile.hpp"
#include "runtime/plant/all_mistakes.hpp"
#include "runtime/plant_file/line_alone.hpp"
#include "runtime/unit/program_image.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::library {
namespace {

namespace fs = std::filesystem;

constexpr uintmax_t kFileLimit = uintmax_t{64} << 20U;  // far above any plant, program or image (ours)

// Regular files only: a device or a pipe could have no end.
tl::expected<std::string, std::string> read_file(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return tl::unexpected(std::string("there is no such file"));
  if (!fs::is_regular_file(path, error)) return tl::unexpected(std::string("is no file"));
  if (fs::file_size(path, error) > kFileLimit) return tl::unexpected(std::string("is too large"));
  std::ifstream in(fs::path(path), std::ios::binary);
  if (!in) return tl::unexpected(std::string("cannot be read"));
  return std::string(std::istreambuf_iterator<char>(in), {});
}

std::optional<std::string> try_read_file(const std::string& path) {
  auto text = read_file(path);
  return text ? std::optional(*std::move(text)) : std::nullopt;
}

// In small letters, with the dot.
std::string ending(const std::string& path) {
  std::string text = fs::path(path).extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string beside(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / name).lexically_normal().string();
}

Mistakes mistakes_of(const compiler::Compilation& compiled) {
  Mistakes mistakes;
  for (const compiler::Diagnostic& diagnostic : compiled.diagnostics.all()) {
    if (diagnostic.severity != compiler::Severity::Error) continue;
    const compiler::Position at = compiled.sources->position(diagnostic.span.begin);
    mistakes.push_back({at.file == nullptr ? "" : at.file->name, at.line, at.column,
                        fmt::format("{} [{}]", diagnostic.text, compiler::info(diagnostic.diag).code)});
  }
  return mistakes;
}

Mistakes mistakes_of(const std::string& file, const std::vector<runtime::PlantError>& errors) {
  Mistakes mistakes;
  for (const runtime::PlantError& error : errors)
    mistakes.push_back({file, error.place.line, error.place.column, error.text});
  return mistakes;
}

// The image decides where the plant names no unit. Why it cannot run there.
std::optional<std::string> use_unit(const vm::Image& image, runtime::StationConfig& station) {
  const stdlib::UnitType* unit = stdlib::find_unit(image.unit);
  if (unit == nullptr || unit->tasks == 0) return "is for a unit that runs no program";
  if (station.unit != nullptr && station.unit != unit)
    return fmt::format("is for unit {}, the station is {}", unit->name, station.unit->name);
  station.unit = unit;
  return std::nullopt;
}

runtime::PlantFile plant_of_program(const std::string& path) {
  runtime::PlantFile plant;
  runtime::StationConfig station;
  station.name = fs::path(path).stem().string();
  station.program = fs::path(path).filename().string();
  plant.stations.push_back(std::move(station));
  return plant;
}

// FNV-1a, 64 bits.
class Fingerprint {
 public:
  void add(std::string_view bytes) {
    for (const char c : bytes) add_byte(static_cast<unsigned char>(c));
    add_number(bytes.size());
  }
  void add_number(uint64_t value) {
    for (int n = 0; n < 8; ++n) add_byte(static_cast<uint8_t>(value >> (8 * n)));
  }
  uint64_t value() const { return value_; }

 private:
  void add_byte(uint8_t byte) { value_ = (value_ ^ byte) * 0x100000001B3; }
  uint64_t value_ = 0xCBF29CE484222325;
};

}  // namespace

tl::expected<Contents, Mistakes> Contents::read(const Source& source) {
  Contents contents;
  contents.name_ = source.path.empty() ? "plant" : source.path;
  contents.folder_ = source.folder.value_or(fs::path(source.path).parent_path().string());
  const bool is_program = !source.text && (ending(source.path) == ".ipc" || ending(source.path) == ".ipx");
  std::string text;
  std::vector<runtime::PlantError> errors;
  if (is_program) {
    contents.file_ = plant_of_program(source.path);
  } else {
    if (source.text) {
      text = *source.text;
    } else {
      auto file = read_file(source.path);
      if (!file) return tl::unexpected(Mistakes{{source.path, 0, 0, file.error()}});
      text = *std::move(file);
    }
    runtime::PlantFileResult read = runtime::read_plant_file(text, source.path);
    errors = std::move(read.errors);
    contents.file_ = source.lone_line ? runtime::line_alone(read.plant, *source.lone_line) : std::move(read.plant);
  }
  for (runtime::StationConfig& station : contents.file_.stations) {
    station.nvram_use = source.write_memory ? runtime::FileUse::Write : runtime::FileUse::Look;
    if (!station.nvram.empty()) station.nvram = beside(contents.folder_, station.nvram);
  }
  for (runtime::FaultConfig& fault : contents.file_.faults) fault.fault.seed += source.seed;
  if (source.commands_a_ms != 0)
    contents.rates_ = vm::Rates{{source.commands_a_ms, source.commands_a_ms, source.commands_a_ms}};
  Mistakes of_programs;
  if (source.given)
    contents.take_given(*source.given, errors);
  else
    contents.load_programs(source, errors, of_programs);
  if (!errors.empty() || !of_programs.empty()) {
    if (!is_program)
      errors = runtime::all_mistakes(contents.file_, std::move(contents.programs_), std::move(errors));
    Mistakes mistakes = mistakes_of(contents.name_, errors);
    mistakes.insert(mistakes.end(), of_programs.begin(), of_programs.end());
    return tl::unexpected(std::move(mistakes));
  }
  contents.identify(text, source);
  return contents;
}

void Contents::load_programs(const Source& source, std::vector<runtime::PlantError>& errors, Mistakes& of_programs) {
  const bool has_mistakes = !errors.empty();
  for (runtime::StationConfig& station : file_.stations) {
    programs_.emplace_back();
    if (station.program.empty() || (has_mistakes && station.unit == nullptr)) continue;
    programs_.back() = load_program(source, station, errors, of_programs);
  }
}

std::optional<vm::Image> Contents::load_program(const Source& source, runtime::StationConfig& station,
                                                std::vector<runtime::PlantError>& errors, Mistakes& of_programs) {
  const auto mistake = [&](std::string text) {
    errors.push_back({station.program_place, fmt::format("station '{}': {}", station.name, std::move(text))});
    return std::nullopt;
  };
  const std::string path = beside(folder_, station.program);
  auto bytes = read_file(path);
  if (!bytes) return mistake(fmt::format("program {}: {}", path, bytes.error()));
  vm::Image image;
  if (ending(path) == ".ipc") {
    compiler::CompileOptions options;
    options.include_dirs = source.include_dirs;
    options.defines = source.defines;
    options.read_file = try_read_file;
    options.unit = station.unit;
    compiler::Compilation compiled = compiler::compile(path, path, *std::move(bytes), options);
    if (!compiled.image) {
      const Mistakes found = mistakes_of(compiled);
      of_programs.insert(of_programs.end(), found.begin(), found.end());
      return std::nullopt;
    }
    image = *std::move(compiled.image);
  } else {
    auto read = runtime::read_program_image({reinterpret_cast<const uint8_t*>(bytes->data()), bytes->size()});
    if (!read) return mistake(fmt::format("image {} {}", path, read.error()));
    image = *std::move(read);
  }
  if (auto why = use_unit(image, station)) return mistake(fmt::format("{} {}", path, *why));
  return image;
}

void Contents::take_given(const std::vector<Source::Given>& given, std::vector<runtime::PlantError>& errors) {
  programs_.resize(file_.stations.size());
  for (size_t n = 0; n < file_.stations.size(); ++n) {
    runtime::StationConfig& station = file_.stations[n];
    const bool is_there = n < given.size();
    station.nvram = is_there ? given[n].memory : std::string();
    if (is_there) programs_[n] = given[n].program;
    if (programs_[n].has_value() == station.program.empty())
      errors.push_back({station.place, fmt::format("station '{}': the image and the plant do not belong together", station.name)});
    else if (const auto why = programs_[n] ? use_unit(*programs_[n], station) : std::nullopt)
      errors.push_back({station.program_place, fmt::format("station '{}': the image {}", station.name, *why)});
  }
}

void Contents::identify(std::string_view text, const Source& source) {
  Fingerprint print;
  print.add(text);
  if (source.lone_line) print.add(*source.lone_line);
  for (const auto& program : programs_) {
    const std::vector<uint8_t> bytes = program ? vm::write_image(*program) : std::vector<uint8_t>();
    print.add({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  print.add_number(source.commands_a_ms);
  print.add_number(source.seed);
  identity_ = print.value();
}

bool Contents::writes_memory() const {
  return std::any_of(file_.stations.begin(), file_.stations.end(), [](const runtime::StationConfig& station) {
    return !station.nvram.empty() && station.nvram_use == runtime::FileUse::Write;
  });
}

tl::expected<std::unique_ptr<runtime::Plant>, Mistakes> Contents::build() const {
  std::vector<runtime::PlantError> errors;
  auto plant = std::make_unique<runtime::Plant>(file_, programs_, rates_, errors, execution_);
  if (!errors.empty()) return tl::unexpected(mistakes_of(name_, errors));
  return plant;
}

}  // namespace ipos::library
