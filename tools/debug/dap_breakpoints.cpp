// Requests of the debug adapter protocol: what a plant stops for.
#include <fmt/format.h>

#include <algorithm>

#include "tools/debug/dap.hpp"
#include "tools/lsp_base/positions.hpp"

namespace ipos::tools::debug {

Json DapServer::breakpoint_json(const Breakpoint& breakpoint) const {
  const SourcePlace place = debugger_->code(breakpoint.station)->place(breakpoint.address);
  Json json{{"id", breakpoint.id},
            {"verified", true},
            {"instructionReference", command_reference(breakpoint.station, breakpoint.address)}};
  if (place.line != 0) json["line"] = line_for_client(place.line);
  return json;
}

Json DapServer::set_breakpoints(const Json& arguments) {
  auto& all = debugger().breakpoints();
  const Json& source = arguments.at("source");
  const std::string asked_file = source.value("path", source.value("name", ""));
  const std::string file = uris_ ? lsp::path_of(asked_file) : asked_file;
  std::erase_if(all, [&](const Breakpoint& point) {
    const auto known = sources_.find(point.id);
    return known != sources_.end() && known->second.first == file;
  });
  Json answer = Json::array();
  for (const Json& asked : arguments.value("breakpoints", Json::array())) {
    const uint32_t line = line_of_client(asked.at("line"));
    Json shown;
    // A source that several stations run stops each of them; the editor hears of one.
    for (uint32_t station = 0; station < debugger_->plant().stations().size(); ++station) {
      const CodeMap* code = debugger_->code(station);
      const auto address = code == nullptr ? std::nullopt : code->address_of(file, line);
      if (!address) continue;
      Breakpoint made{debugger_->next_id(),
                      station,
                      *address,
                      asked.value("condition", ""),
                      asked.value("hitCondition", ""),
                      asked.value("logMessage", ""),
                      false,
                      true,
                      0};
      sources_[made.id] = {file, line};
      if (shown.is_null()) shown = breakpoint_json(made);
      all.push_back(std::move(made));
    }
    if (shown.is_null())
      shown = {{"verified", false}, {"line", line_for_client(line)}, {"message", "no command belongs to this line"}};
    answer.push_back(std::move(shown));
  }
  return {{"breakpoints", answer}};
}

Json DapServer::set_instruction_breakpoints(const Json& arguments) {
  auto& all = debugger().breakpoints();
  std::erase_if(all, [&](const Breakpoint& point) {
    return !sources_.contains(point.id) &&
           std::find(function_points_.begin(), function_points_.end(), point.id) == function_points_.end();
  });
  Json answer = Json::array();
  for (const Json& asked : arguments.at("breakpoints")) {
    const auto command = command_of_reference(asked.at("instructionReference").get<std::string>(),
                                              asked.value("offset", int64_t{0}));
    if (!command || command->address < 0 ||
        !debugger_->code(command->station)->is_command(static_cast<uint32_t>(command->address))) {
      answer.push_back({{"verified", false}, {"message", "no command begins there"}});
      continue;
    }
    all.push_back({debugger_->next_id(), command->station, static_cast<uint32_t>(command->address),
                   asked.value("condition", ""), asked.value("hitCondition", ""), "", false, true, 0});
    answer.push_back(breakpoint_json(all.back()));
  }
  return {{"breakpoints", answer}};
}

// By its name in a list of variables, or by itself.
ValuePlace DapServer::place_asked_for(const Json& arguments) {
  uint32_t station = 0;
  const auto reference = arguments.value("variablesReference", 0U);
  if (reference > 0 && reference <= references_.size()) station = references_[reference - 1].station;
  std::string name = arguments.at("name");
  if (reference > 0 && reference <= references_.size()) name = references_[reference - 1].name + name;
  return evaluate_place(debugger().plant(), station, name);
}

// An editor asks when it opens a menu, so the last writer comes only where the way back is short.
Json DapServer::data_breakpoint_info(const Json& arguments) {
  constexpr uint64_t kShortWay = 1'000'000;  // commands; less than a second (docs/guide/debugging.md, How time goes back)
  try {
    const ValuePlace place = place_asked_for(arguments);
    const std::string station = debugger_->plant().stations()[place.station]->config().name;
    const std::string whole = place.name.starts_with(station + ".") ? place.name : station + "." + place.name;
    if (debugger_->position().commands <= kShortWay) order_ = who_.ask(*debugger_, {}, place);  // carry_on() adds who it was
    return {{"dataId", Json(place).dump()},
            {"description", whole},
            {"accessTypes", Json::array({"write"})},
            {"canPersist", false}};
  } catch (const ValueError& error) {
    return {{"dataId", nullptr}, {"description", error.what()}};
  }
}

Json DapServer::who(const Json& arguments) {
  order_ = who_.ask(debugger(), {}, place_asked_for(arguments));
  return Json::object();  // carry_on() answers
}

// What data_breakpoint_info() has given out; nothing when it is none of that.
std::optional<ValuePlace> DapServer::place_of_data(const std::string& id) {
  const Json json = Json::parse(id, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    const ValuePlace place = json;
    ValuePlace found = evaluate_place(debugger().plant(), place.station, place.name);
    if (found.station == place.station && found.elements == place.elements) return found;
  } catch (const Json::exception&) {
  } catch (const ValueError&) {
  }
  return std::nullopt;
}

Json DapServer::set_data_breakpoints(const Json& arguments) {
  std::erase_if(debugger().watchpoints(), [this](const Watchpoint& point) {
    return std::find(fault_points_.begin(), fault_points_.end(), point.id) == fault_points_.end();
  });
  Json answer = Json::array();
  for (const Json& asked : arguments.at("breakpoints")) {
    const auto place = place_of_data(asked.value("dataId", ""));
    if (!place) {
      answer.push_back({{"verified", false}, {"message", "the data id is none of this session"}});
      continue;
    }
    debugger_->watchpoints().push_back({debugger_->next_id(), place->station, *place,
                                        asked.value("condition", ""), true, 0,
                                        asked.value("hitCondition", "")});
    answer.push_back({{"id", debugger_->watchpoints().back().id}, {"verified", true}});
  }
  return {{"breakpoints", answer}};
}

// A program that faults stops anyway.
Json DapServer::set_exception_breakpoints(const Json& arguments) {
  auto& all = debugger().watchpoints();
  std::erase_if(all, [this](const Watchpoint& point) {
    return std::find(fault_points_.begin(), fault_points_.end(), point.id) != fault_points_.end();
  });
  fault_points_.clear();
  const Json filters = arguments.value("filters", Json::array());
  if (std::find(filters.begin(), filters.end(), "fault") == filters.end()) return Json::object();
  const auto& stations = debugger_->plant().stations();
  for (uint32_t n = 0; n < stations.size(); ++n) {
    std::string name = stations[n]->config().name + ".fault";
    auto place = find_value(debugger_->plant(), n, name);
    if (place->signal->is_variable()) {  // the program calls a variable so
      name = stations[n]->config().name + ".drive.fault";
      place = find_value(debugger_->plant(), n, name);
    }
    all.push_back({debugger_->next_id(), n, *place, name, true, 0});
    fault_points_.push_back(all.back().id);
  }
  return Json::object();
}

// The commands at which a function of this name begins, in all stations; else a name is a frame: "40A#80*",
// "sbus1 40A#*", or the bytes of a telegram.
Json DapServer::set_function_breakpoints(const Json& arguments) {
  auto& all = debugger().breakpoints();
  std::erase_if(all, [&](const Breakpoint& point) {
    return std::find(function_points_.begin(), function_points_.end(), point.id) != function_points_.end();
  });
  function_points_.clear();
  frames_.clear();
  Json answer = Json::array();
  for (const Json& asked : arguments.value("breakpoints", Json::array())) {
    const auto name = asked.at("name").get<std::string>();
    Json shown;
    for (uint32_t station = 0; station < debugger_->plant().stations().size(); ++station) {
      const CodeMap* code = debugger_->code(station);
      const auto address = code == nullptr ? std::nullopt : code->function_address(name);
      if (!address) continue;
      all.push_back({debugger_->next_id(), station, *address, asked.value("condition", ""),
                     asked.value("hitCondition", ""), "", false, true, 0});
      function_points_.push_back(all.back().id);
      if (shown.is_null()) shown = breakpoint_json(all.back());
    }
    if (shown.is_null() && FramePoints::is_frame(debugger_->plant(), name)) {
      frames_.add({debugger_->next_id(), name, asked.value("condition", ""), asked.value("hitCondition", "")});
      shown = {{"id", frames_.all().back().id}, {"verified", true}};
    }
    if (shown.is_null())
      shown = {{"verified", false},
               {"message", "no program has a function of this name, and it is no frame such as 40A#80*"}};
    answer.push_back(std::move(shown));
  }
  return {{"breakpoints", answer}};
}

// The lines from `line` to `endLine` at which a command begins, in any station.
Json DapServer::breakpoint_locations(const Json& arguments) {
  constexpr uint32_t kMostLines = 10'000;
  const Json& source = arguments.at("source");
  const std::string asked = source.value("path", source.value("name", ""));
  const std::string file = uris_ ? lsp::path_of(asked) : asked;
  const uint32_t first = line_of_client(arguments.at("line"));
  const uint32_t last = arguments.contains("endLine") ? line_of_client(arguments["endLine"]) : first;
  Json all = Json::array();
  for (uint32_t line = first; line <= last && line - first < kMostLines; ++line)
    for (uint32_t station = 0; station < debugger().plant().stations().size(); ++station) {
      const CodeMap* code = debugger_->code(station);
      const auto address = code == nullptr ? std::nullopt : code->address_of(file, line);
      if (!address || code->place(*address).line != line) continue;
      all.push_back({{"line", line_for_client(line)}, {"column", column_for_client(code->place(*address).column)}});
      break;
    }
  return {{"breakpoints", all}};
}

// "F10: division by zero" and where it was.
Json DapServer::exception_info(const Json&) {
  if (fault_.empty()) throw ValueError("no fault has stopped the plant");
  return {{"exceptionId", fault_.substr(0, fault_.find(':'))}, {"description", fault_}, {"breakMode", "always"}};
}

}  // namespace ipos::tools::debug
