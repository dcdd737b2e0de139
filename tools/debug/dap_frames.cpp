// Requests of the debug adapter protocol: frames and commands of a plant that stands still.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "stdlib/headers.hpp"
#include "tools/debug/dap.hpp"
#include "tools/debug/jump.hpp"
#include "tools/input/sources.hpp"
#include "tools/lsp_base/positions.hpp"

namespace ipos::tools::debug {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kMostShown = 10'000;  // commands of one request

// Without .. where that is the same file: an editor takes another spelling for another document.
std::string whole_path(const std::string& file) {
  std::error_code error;
  const fs::path path = fs::absolute(file, error);
  const fs::path normal = path.lexically_normal();
  return (normal == path || fs::equivalent(normal, path, error) ? normal : path).string();
}

}  // namespace

uint32_t DapServer::line_of_client(const Json& line) const {
  const int64_t number = line.get<int64_t>() + (lines_from_1_ ? 0 : 1);
  return static_cast<uint32_t>(std::clamp<int64_t>(number, 0, UINT32_MAX));
}

std::string DapServer::path_for_client(const std::string& path) const {
  const std::string whole = whole_path(path);
  return uris_ ? lsp::uri_of(whole) : whole;
}

// A block of the compiler is no file: the editor asks for its text by its number.
Json DapServer::source_for_client(const std::string& file) const {
  std::error_code error;
  const auto built_in = stdlib::built_in_files();
  const stdlib::EmbeddedFile* text = fs::exists(file, error) ? nullptr : stdlib::find_built_in_file(file);
  if (text != nullptr)
    return {{"name", file}, {"path", file}, {"sourceReference", text - built_in.data() + 1}, {"origin", "built in"}};
  Json source{{"name", fs::path(file).filename().string()}, {"path", path_for_client(file)}};
  if (source_has_changed(file)) source["origin"] = "changed since it was compiled: the lines are those of the text that runs";
  return source;
}

Json DapServer::source(const Json& arguments) {
  const auto built_in = stdlib::built_in_files();
  const auto number = arguments.at("sourceReference").get<size_t>();
  if (number == 0 || number > built_in.size()) throw ValueError("there is no source of this number");
  return {{"content", std::string(built_in[number - 1].text)}};
}

// (station + 1) x 65536 + address: what fills a view up in front of the first command has smaller numbers, which belong
// to no other station, as programs are much shorter.
std::string DapServer::command_reference(uint32_t station, int64_t address) {
  return fmt::format("{}", (int64_t{station} + 1) * 65536 + address);
}

std::optional<DapServer::CommandPlace> DapServer::command_of_reference(const std::string& text,
                                                                       int64_t offset) {
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  int64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + (hex ? 2 : 0), end, number, hex ? 16 : 10);
  constexpr int64_t kFarthest = int64_t{1} << 40;
  if (read.ec != std::errc() || read.ptr != end || number < 0 || number > kFarthest || offset < -kFarthest ||
      offset > kFarthest)
    return std::nullopt;
  number += offset;
  const int64_t station = (number + kMostShown) / 65536 - 1;
  const auto& stations = debugger().plant().stations();
  if (number < 0 || station < 0 || station >= static_cast<int64_t>(stations.size()) ||
      debugger_->code(static_cast<uint32_t>(station)) == nullptr)
    return std::nullopt;
  return CommandPlace{static_cast<uint32_t>(station), number - (station + 1) * 65536};
}

Json DapServer::stack_trace(const Json& arguments) {
  const TaskRef task = task_of(arguments, "threadId");
  const std::vector<Frame> frames = debugger_->frames(task);
  const auto from = arguments.value("startFrame", size_t{0});
  const auto levels = arguments.value("levels", size_t{0});
  Json all = Json::array();
  for (size_t n = from; n < frames.size() && (levels == 0 || n < from + levels); ++n) {
    const Frame& frame = frames[n];
    Json one{{"id", arguments.at("threadId").get<int>() * kFramesOfTask + static_cast<int>(n)},
             {"name", frame.function.empty() ? fmt::format("word {}", frame.address) : frame.function},
             {"line", 0},
             {"column", 0},
             {"instructionPointerReference", command_reference(task.station, frame.address)}};
    if (frame.place.line != 0) {
      one["line"] = line_for_client(frame.place.line);
      one["column"] = column_for_client(frame.place.column);
      one["source"] = source_for_client(frame.place.file);
    }
    all.push_back(std::move(one));
  }
  return {{"stackFrames", all}, {"totalFrames", frames.size()}};
}

// Addresses rise, also of what fills up in front of the first command and after the last: editors search in them.
Json DapServer::disassemble(const Json& arguments) {
  const auto place = command_of_reference(arguments.at("memoryReference").get<std::string>(),
                                          arguments.value("offset", int64_t{0}));
  if (!place) throw ValueError("there is no program at this reference");
  const CodeMap& code = *debugger_->code(place->station);
  const auto items = static_cast<int64_t>(code.items().size());
  const auto words = static_cast<int64_t>(debugger_->plant().stations()[place->station]->image()->code.size());
  const int64_t here = place->address < 0        ? place->address
                       : place->address >= words ? items + place->address - words
                                                 : static_cast<int64_t>(code.item_at(static_cast<uint32_t>(place->address)));
  const auto count = std::clamp<int64_t>(arguments.at("instructionCount").get<int64_t>(), 0, kMostShown);
  const int64_t first =
      std::clamp(here + std::clamp(arguments.value("instructionOffset", int64_t{0}), -kMostShown, kMostShown),
                 -kMostShown, items + kMostShown);
  Json all = Json::array();
  for (int64_t n = first; n < first + count; ++n) {
    if (n < 0 || n >= items) {  // the editor wants as many as it asked for
      all.push_back({{"address", command_reference(place->station, n < 0 ? n : words + n - items)},
                     {"instruction", "-"},
                     {"presentationHint", "invalid"}});
      continue;
    }
    const uint32_t address = code.items()[static_cast<size_t>(n)].address;
    Json one{{"address", command_reference(place->station, address)}, {"instruction", code.text(address)}};
    if (const SourcePlace source = code.place(address); source.line != 0) {
      one["line"] = line_for_client(source.line);
      one["location"] = source_for_client(source.file);
    }
    all.push_back(std::move(one));
  }
  return {{"instructions", all}};
}

// The statements that begin at a line, in each station and each copy of its function. The number of a target is that of its
// command in a view.
Json DapServer::goto_targets(const Json& arguments) {
  const Json& source = arguments.at("source");
  const std::string asked = source.value("path", source.value("name", ""));
  const std::string file = uris_ ? lsp::path_of(asked) : asked;
  const uint32_t line = line_of_client(arguments.at("line"));
  Json all = Json::array();
  for (uint32_t station = 0; station < debugger().plant().stations().size(); ++station)
    for (const uint32_t address : statements_at(*debugger_, station, file, line)) {
      const auto id = static_cast<int64_t>(targets_.size()) + 1;
      targets_[id] = {station, address};
      all.push_back({{"id", id},
                     {"label", fmt::format("{} {}", debugger_->plant().stations()[station]->config().name,
                                           debugger_->code(station)->function(address))},
                     {"line", line_for_client(line)},
                     {"instructionPointerReference", command_reference(station, address)}});
    }
  return {{"targets", std::move(all)}};
}

// The thread stands there now, and nothing has been executed.
Json DapServer::go_to(const Json& arguments) {
  const TaskRef task = task_of(arguments, "threadId");
  const auto target = targets_.find(arguments.at("targetId").get<int64_t>());
  if (target == targets_.end()) throw ValueError("there is no such target");
  if (target->second.first != task.station)
    throw ValueError(fmt::format("that is a program of another station than {}", debugger_->task_name(task)));
  // The editor shows a line once: of its copies the one of the function that the task is in.
  uint32_t address = target->second.second;
  const CodeMap& code = *debugger_->code(task.station);
  const SourcePlace place = code.place(address);
  const std::vector<Frame> frames = debugger_->frames(task);
  if (place.line != 0 && !frames.empty())
    for (const uint32_t other : statements_at(*debugger_, task.station, place.file, place.line))
      if (code.function(other) == code.function(frames.front().address)) address = other;
  jump(*debugger_, task, address);
  later_stop_ = task;
  return Json::object();
}

// All sources that a program was compiled from, each once.
Json DapServer::loaded_sources(const Json&) {
  std::vector<std::string> files;
  for (const auto& station : debugger().plant().stations())
    if (station->image() != nullptr)
      for (const std::string& file : station->image()->files)
        if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  Json all = Json::array();
  for (const std::string& file : files) all.push_back(source_for_client(file));
  return {{"sources", std::move(all)}};
}

}  // namespace ipos::tools::debug
