// What runs is kept, not what the files have by now.
#include "tools/serve/host/kept_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "runtime/plant/trace_hash.hpp"

namespace ipos::tools::serve {

using sessions::Session;

namespace {

namespace fs = std::filesystem;

// What runs, where it is known, else what the file has.
std::optional<std::string> running_text(PlantHost& host, const std::string& file) {
  for (uint32_t n = 0; n < host.plant().stations().size(); ++n)
    if (auto text = host.texts().text(n, file)) return text;
  return host.files().text(file);
}

}  // namespace

Session session_of(PlantHost& host, Json settings) {
  Session session;
  session.test = host.files().test_beside();
  session.settings = std::move(settings);
  const auto files = host.files().list();
  const auto plant = std::find_if(files.begin(), files.end(), [](const Files::Entry& entry) {
    return entry.kind == Files::Kind::Plant;
  });
  const auto first = plant != files.end() ? plant : files.begin();
  if (first == files.end()) throw Mistake("no files belong to this plant; a session cannot hold it");
  const fs::path folder = fs::path(first->name).parent_path();
  for (const Files::Entry& entry : files) {
    const bool is_beside = session.test && session.test->file == entry.name;
    if ((entry.kind == Files::Kind::Test && !is_beside) || entry.kind == Files::Kind::Session) continue;
    const std::string name = fs::path(entry.name).lexically_relative(folder.empty() ? "." : folder).generic_string();
    if (!sessions::is_inside(name))
      throw Mistake(fmt::format("{} lies outside of the folder of the plant; a session cannot hold it", entry.name));
    auto text = running_text(host, entry.name);
    if (!text) throw Mistake(fmt::format("{} cannot be read", entry.name));
    session.texts[name] = *std::move(text);
    if (entry.name == first->name) session.plant = name;
    if (is_beside) session.test->file = name;
  }
  for (const runtime::StationConfig& station : host.plant().file().stations)
    if (!station.program.empty() && !session.texts.contains(fs::path(station.program).lexically_normal().generic_string()))
      throw Mistake(fmt::format("{} runs {}, which has no text; a session cannot hold it", station.name, station.program));
  session.moment = host.debugger().position();
  for (const debug::Change& change : host.debugger().changes()) {
    if (change.at > session.moment) continue;
    if (change.action.is_object() && change.action.value("act", "") == "load")
      throw Mistake("a program was loaded while the plant ran; restart it, so that the session holds one program a station");
    session.actions.push_back(change);
  }
  session.digest = runtime::state_digest(host.plant());
  return session;
}

}  // namespace ipos::tools::serve
