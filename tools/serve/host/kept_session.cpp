// What runs is kept, not what the files have by now.
#include "tools/serve/host/kept_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "runtime/plant/trace_hash.hpp"

namespace ipos::tools::serve {

using sessions::Session;

namespace {

// What runs, where it is known, else what the file has.
std::optional<std::string> running_text(PlantHost& host, const std::string& file) {
  for (uint32_t n = 0; n < host.plant().stations().size(); ++n)
    if (auto text = host.texts().text(n, file)) return text;
  return host.files().text(file);
}

// The plant, its programs with what they include, and the test that runs beside it.
bool belongs(const Files::Entry& entry, const Session& session) {
  if (entry.kind == Files::Kind::Session) return false;
  return entry.kind != Files::Kind::Test || (session.test && session.test->file == entry.name);
}

}  // namespace

Session session_of(PlantHost& host, Json settings) {
  Session session;
  session.test = host.files().test_beside();
  session.settings = std::move(settings);
  const auto files = host.files().list();
  std::vector<std::string> names;
  for (const Files::Entry& entry : files)
    if (belongs(entry, session)) names.push_back(entry.name);
  if (names.empty()) throw Mistake("no files belong to this plant; a session cannot hold it");
  const auto plant = std::find_if(files.begin(), files.end(), [](const Files::Entry& entry) {
    return entry.kind == Files::Kind::Plant;
  });
  const std::string first = plant != files.end() ? plant->name : names.front();
  // A test, a program or what it includes may lie beside the folder of the plant.
  const std::string folder = sessions::common_folder(names);
  const auto name_of = [&](const std::string& program) {
    return sessions::name_in(folder, (std::filesystem::path(first).parent_path() / program).generic_string());
  };
  for (const std::string& file : names) {
    const std::string name = sessions::name_in(folder, file);
    if (!sessions::is_inside(name)) throw Mistake(fmt::format("{} lies on another drive than the rest; a session cannot hold it", file));
    auto text = running_text(host, file);
    if (!text) throw Mistake(fmt::format("{} cannot be read", file));
    session.texts[name] = *std::move(text);
  }
  session.plant = sessions::name_in(folder, first);
  if (session.test) session.test->file = sessions::name_in(folder, session.test->file);
  for (const runtime::StationConfig& station : host.plant().file().stations)
    if (!station.program.empty() && !session.texts.contains(name_of(station.program)))
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
