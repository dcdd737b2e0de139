// Writing and reading the files, and the number over all of them.
#include "runtime/fmi/package.hpp"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "runtime/unit/program_image.hpp"

namespace ipos::fmi {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kList = "fmu.txt", kPlant = "plant.toml", kForm = "ipos-fmu 1";
constexpr uintmax_t kMostBytes = uintmax_t{64} << 20U;  // of a file (ours), as of plants and programs elsewhere

// FNV-1a of 64 bits from two beginnings: enough to tell contents apart, no secret.
std::string token_of(const std::map<std::string, std::string>& files, std::string_view program) {
  uint64_t halves[] = {0xCBF29CE484222325, 0x6C62272E07BB0142};
  const auto add = [&](std::string_view bytes) {
    for (uint64_t& half : halves) {
      for (const char c : bytes) half = (half ^ static_cast<unsigned char>(c)) * 0x100000001B3;
      half = (half ^ bytes.size()) * 0x100000001B3;
    }
  };
  add(program);
  for (const auto& [name, bytes] : files) {
    add(name);
    add(bytes);
  }
  const std::string digits = fmt::format("{:016x}{:016x}", halves[0], halves[1]);
  return fmt::format("{{{}-{}-{}-{}-{}}}", digits.substr(0, 8), digits.substr(8, 4), digits.substr(12, 4), digits.substr(16, 4),
                     digits.substr(20));
}

std::string program_name(size_t station) { return fmt::format("program{}.ipx", station + 1); }
std::string memory_name(size_t station) { return fmt::format("memory{}.nvm", station + 1); }

tl::expected<std::string, std::string> read_file(const std::string& folder, const std::string& name) {
  const fs::path path = fs::path(folder) / name;
  const auto wrong = [&](std::string_view why) { return tl::unexpected(fmt::format("{}: {}", path.string(), why)); };
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return wrong("there is no such file");
  if (fs::file_size(path, error) > kMostBytes) return wrong("is too large");
  std::ifstream in(path, std::ios::binary);
  if (!in) return wrong("cannot be read");
  return std::string(std::istreambuf_iterator<char>(in), {});
}

tl::expected<vm::Image, std::string> read_program(const std::string& folder, const std::string& name) {
  const auto bytes = read_file(folder, name);
  if (!bytes) return tl::unexpected(bytes.error());
  auto image = runtime::read_program_image({reinterpret_cast<const uint8_t*>(bytes->data()), bytes->size()});
  if (!image) return tl::unexpected(fmt::format("{}/{} {}", folder, name, image.error()));
  return *std::move(image);
}

// Of "program 2 program1.ipx" the station and the file. No file but those beside the list.
struct StationFile {
  size_t station;
  std::string file;
};
std::optional<StationFile> read_station_file(std::string_view text) {
  size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || number == 0 || number > 10'000 || end == text.data() + text.size() || *end != ' ')
    return std::nullopt;
  std::string file(end + 1, text.data() + text.size());
  if (file.empty() || file.find_first_of("/\\:") != std::string::npos || file.starts_with('.')) return std::nullopt;
  return StationFile{number - 1, std::move(file)};
}

// "2 sbus"
std::optional<LineChoice> read_line(const std::string& text) {
  LineChoice line;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, line.terminals);
  if (error != std::errc() || end == last || *end != ' ' || line.terminals < 1 || line.terminals > kMostTerminals) return std::nullopt;
  line.bus.assign(end + 1, last);
  return line;
}

}  // namespace

std::map<std::string, std::string> files_of(Package& package, const std::string& program) {
  std::map<std::string, std::string> files;
  std::map<std::string, std::string> known;  // a program that many stations have is there once
  files[std::string(kPlant)] = package.plant;
  std::string list = fmt::format("{}\n", kForm);
  for (size_t n = 0; n < package.stations.size(); ++n) {
    const Package::Station& station = package.stations[n];
    if (station.program) {
      const std::vector<uint8_t> bytes = vm::write_image(*station.program);
      std::string text(bytes.begin(), bytes.end());
      const auto [file, is_new] = known.try_emplace(text, program_name(n));
      if (is_new) files[file->second] = std::move(text);
      list += fmt::format("program {} {}\n", n + 1, file->second);
    }
    if (station.memory) {
      files[memory_name(n)] = *station.memory;
      list += fmt::format("memory {} {}\n", n + 1, memory_name(n));
    }
  }
  if (const auto& line = package.choice.line) list += fmt::format("line {} {}\n", line->terminals, line->bus);
  for (const std::string& station : package.choice.stations) list += fmt::format("station {}\n", station);
  for (const std::string& signal : package.choice.signals) list += fmt::format("signals {}\n", signal);
  files[std::string(kList)] = list;
  package.token = token_of(files, program);
  files[std::string(kList)] += fmt::format("token {}\n", package.token);
  return files;
}

tl::expected<Package, std::string> read_package(const std::string& folder) {
  const auto list = read_file(folder, std::string(kList));
  if (!list) return tl::unexpected(list.error());
  auto plant = read_file(folder, std::string(kPlant));
  if (!plant) return tl::unexpected(plant.error());
  Package package;
  package.plant = *std::move(plant);
  std::istringstream lines(*list);
  std::string line;
  for (size_t number = 1; std::getline(lines, line); ++number) {
    const size_t blank = std::min(line.find(' '), line.size());
    const std::string_view key = std::string_view(line).substr(0, blank);
    const std::string value = blank == line.size() ? std::string() : line.substr(blank + 1);
    const auto wrong = [&] { return tl::unexpected(fmt::format("{}/{}:{}: is no line of an FMU of ipos", folder, kList, number)); };
    if (number == 1) {
      if (line != kForm) return wrong();
    } else if (key == "station") {
      package.choice.stations.push_back(value);
    } else if (key == "signals") {
      package.choice.signals.push_back(value);
    } else if (key == "line") {
      package.choice.line = read_line(value);
      if (!package.choice.line) return wrong();
    } else if (key == "token") {
      package.token = value;
    } else {
      const auto file = key == "program" || key == "memory" ? read_station_file(value) : std::nullopt;
      if (!file) return wrong();
      if (package.stations.size() <= file->station) package.stations.resize(file->station + 1);
      Package::Station& station = package.stations[file->station];
      if (key == "memory") {
        station.memory_file = (fs::path(folder) / file->file).string();
      } else {
        auto image = read_program(folder, file->file);
        if (!image) return tl::unexpected(std::move(image).error());
        station.program = *std::move(image);
      }
    }
  }
  return package;
}

tl::expected<library::Contents, std::string> contents_of(const Package& package) {
  library::Source source;
  source.path = kPlant;
  source.text = package.plant;
  source.given.emplace();
  if (package.choice.line) source.lone_line = package.choice.line->bus;
  for (const Package::Station& station : package.stations) source.given->push_back({station.program, station.memory_file});
  auto contents = library::Contents::read(source);
  if (contents) return *std::move(contents);
  const library::Mistake& first = contents.error().front();
  return tl::unexpected(fmt::format("{}:{}:{}: {}", first.file, first.line, first.column, first.text));
}

}  // namespace ipos::fmi
