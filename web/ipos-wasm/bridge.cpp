// What index.js calls: the plant library (ipos_plant.h) and the compiler with nothing but numbers and texts in their
// arguments, as JavaScript has no structures of C. A text that is made of several parts has one a line.
#include <emscripten/emscripten.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "compiler/compile.hpp"
#include "runtime/library/include/ipos_plant.h"
#include "vm/image/image.hpp"

#define FOR_JS extern "C" EMSCRIPTEN_KEEPALIVE

namespace {

using namespace ipos;

constexpr double kNanosecondsInMs = 1e6;
std::string text;             // handed out last
std::vector<uint8_t> image;  // of the last compilation

const char* lines(std::initializer_list<std::string> parts) {
  text.clear();
  for (const std::string& part : parts) text += (text.empty() ? "" : "\n") + part;
  return text.c_str();
}

std::optional<std::string> read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
}

// A frame as index.js reads it out of the memory: 32 bytes.
struct JsFrame {
  double ms;
  uint32_t id, flags, length, unused;
  uint8_t data[8];
};
static_assert(sizeof(JsFrame) == 32);
constexpr size_t kFramesACall = 256;
JsFrame frames[kFramesACall];

}  // namespace

FOR_JS const char* js_version() {
  const uint32_t version = ipos_plant_version();
  return lines({std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." + std::to_string(version % 100)});
}

FOR_JS ipos_plant* js_open(const char* path, uint32_t commands_a_ms, double seed) {
  ipos_plant_source source{};
  source.path = path;
  source.commands_a_ms = commands_a_ms;
  source.seed = static_cast<uint64_t>(seed);
  ipos_plant* plant = nullptr;
  ipos_plant_open(&source, &plant);
  return plant;
}
FOR_JS void js_close(ipos_plant* plant) { ipos_plant_close(plant); }
FOR_JS const char* js_message(ipos_plant* plant) { return ipos_plant_message(plant); }

// file, line, column, text; null after the last.
FOR_JS const char* js_mistake(ipos_plant* plant, uint32_t number) {
  ipos_plant_mistake mistake;
  if (ipos_plant_mistake_at(plant, number, &mistake) != IPOS_PLANT_OK) return nullptr;
  return lines({mistake.file, std::to_string(mistake.line), std::to_string(mistake.column), mistake.text});
}

FOR_JS double js_time(ipos_plant* plant) {
  int64_t ns = 0;
  ipos_plant_time(plant, &ns);
  return static_cast<double>(ns) / kNanosecondsInMs;
}
FOR_JS int js_run(ipos_plant* plant, double ms) {
  int64_t now = 0;
  const ipos_plant_status status = ipos_plant_time(plant, &now);
  return status != IPOS_PLANT_OK ? status : ipos_plant_run(plant, now + static_cast<int64_t>(ms * kNanosecondsInMs));
}

// name, unit, title, program; null after the last.
FOR_JS const char* js_station(ipos_plant* plant, uint32_t number) {
  ipos_plant_station_info info;
  if (ipos_plant_station_at(plant, number, &info) != IPOS_PLANT_OK) return nullptr;
  return lines({info.name, info.unit, info.title, info.program});
}
FOR_JS const char* js_why(ipos_plant* plant, uint32_t station) {
  const char* why = nullptr;
  return ipos_plant_why(plant, station, &why) == IPOS_PLANT_OK ? why : nullptr;
}
FOR_JS int js_drive_fault(ipos_plant* plant, uint32_t station, uint32_t number) {
  return number == 0 ? ipos_plant_reset_fault(plant, station)
                     : ipos_plant_drive_fault(plant, station, static_cast<uint8_t>(number));
}
FOR_JS int js_power(ipos_plant* plant, uint32_t station, int on) { return ipos_plant_power(plant, station, on != 0); }

// The number of a signal, -1 without.
FOR_JS int js_find(ipos_plant* plant, uint32_t station, const char* name) {
  uint32_t signal = 0;
  return ipos_plant_find(plant, station, IPOS_PLANT_ANY, name, &signal) == IPOS_PLANT_OK ? static_cast<int>(signal) : -1;
}
// name, unit, factor, decimals, kind, 1 if it can be written.
FOR_JS const char* js_signal(ipos_plant* plant, uint32_t signal) {
  ipos_plant_signal_info info;
  if (ipos_plant_signal_info_of(plant, signal, &info) != IPOS_PLANT_OK) return nullptr;
  char factor[32];
  std::snprintf(factor, sizeof factor, "%.17g", info.factor);
  return lines({info.name, info.unit, factor, std::to_string(info.decimals), std::to_string(info.kind),
                std::to_string(info.flags & IPOS_PLANT_WRITABLE)});
}
FOR_JS const char* js_name_at(ipos_plant* plant, uint32_t station, int kind, uint32_t number) {
  const char* name = nullptr;
  return ipos_plant_name_at(plant, station, kind, nullptr, number, &name) == IPOS_PLANT_OK ? name : nullptr;
}
FOR_JS double js_read(ipos_plant* plant, uint32_t signal) {
  int64_t value = 0;
  ipos_plant_read(plant, signal, &value);
  return static_cast<double>(value);
}
FOR_JS const char* js_read_text(ipos_plant* plant, uint32_t signal) {
  const char* words = nullptr;
  return ipos_plant_read_text(plant, signal, &words) == IPOS_PLANT_OK ? words : nullptr;
}
FOR_JS int js_write(ipos_plant* plant, uint32_t signal, double value) {
  return ipos_plant_write(plant, signal, static_cast<int64_t>(value));
}
FOR_JS int js_write_text(ipos_plant* plant, uint32_t signal, const char* value) {
  return ipos_plant_write_text(plant, signal, value);
}
FOR_JS int js_force(ipos_plant* plant, uint32_t signal, double value) {
  return ipos_plant_force(plant, signal, static_cast<int64_t>(value));
}
FOR_JS int js_release(ipos_plant* plant, uint32_t signal) { return ipos_plant_release(plant, signal); }

// name, kind, rate; null after the last.
FOR_JS const char* js_bus(ipos_plant* plant, uint32_t number) {
  ipos_plant_bus_info info;
  if (ipos_plant_bus_at(plant, number, &info) != IPOS_PLANT_OK) return nullptr;
  return lines({info.name, std::to_string(info.kind), std::to_string(info.baud)});
}
// How many frames lie at js_frames() then; -1: the bus has none.
FOR_JS int js_receive(ipos_plant* plant, uint32_t bus) {
  ipos_plant_frame taken[kFramesACall];
  size_t count = 0;
  if (ipos_plant_receive(plant, bus, taken, kFramesACall, &count) != IPOS_PLANT_OK) return -1;
  for (size_t n = 0; n < count; ++n) {
    const ipos_plant_frame& from = taken[n];
    JsFrame& to = frames[n];
    to = {static_cast<double>(from.time) / kNanosecondsInMs, from.id, from.flags, from.length, 0, {}};
    std::copy(std::begin(from.data), std::end(from.data), to.data);
  }
  return static_cast<int>(count);
}
FOR_JS JsFrame* js_frames() { return frames; }
// Sends the first one of js_frames().
FOR_JS int js_send(ipos_plant* plant, uint32_t bus) {
  ipos_plant_frame frame{};
  frame.id = frames[0].id;
  frame.flags = frames[0].flags;
  frame.length = static_cast<uint8_t>(frames[0].length);
  std::copy(std::begin(frames[0].data), std::end(frames[0].data), frame.data);
  return ipos_plant_send(plant, bus, &frame, nullptr);
}

// time in ms, weight, station, text; null after the last.
FOR_JS const char* js_journal(ipos_plant* plant, uint32_t number) {
  ipos_plant_entry entry;
  if (ipos_plant_journal_at(plant, number, &entry) != IPOS_PLANT_OK) return nullptr;
  return lines({std::to_string(static_cast<double>(entry.time) / kNanosecondsInMs), std::to_string(entry.weight), entry.station,
                entry.text});
}
// In hexadecimal, as `ipos run --trace-hash` prints it.
FOR_JS const char* js_hash(ipos_plant* plant) {
  uint64_t hash = 0;
  if (ipos_plant_trace_hash(plant, &hash) != IPOS_PLANT_OK) return nullptr;
  char words[17];
  std::snprintf(words, sizeof words, "%016llx", static_cast<unsigned long long>(hash));
  return lines({words});
}

// Compiles; the messages, four lines each: code, line, column, text; null for a unit that is none. js_image() has the image.
FOR_JS const char* js_compile(const char* path, const char* unit) {
  compiler::CompileOptions options;
  options.read_file = read_text;
  if (*unit != 0 && (options.unit = stdlib::find_unit(std::string_view(unit))) == nullptr) return nullptr;
  const compiler::Compilation made = compiler::compile(path, path, read_text(path).value_or(""), options);
  image.clear();
  if (made.image) image = vm::write_image(*made.image);
  text.clear();
  for (const compiler::Diagnostic& one : made.diagnostics.all()) {
    const compiler::DiagInfo& row = compiler::info(one.diag);
    const auto place = made.sources->position(one.span.begin);
    text += std::string(row.code) + "\n" + std::to_string(place.line) + "\n" + std::to_string(place.column) + "\n" + one.text + "\n";
  }
  return text.c_str();
}
FOR_JS const uint8_t* js_image() { return image.data(); }
FOR_JS uint32_t js_image_size() { return static_cast<uint32_t>(image.size()); }
