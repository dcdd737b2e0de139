// A session as a file, NAME.ipos: the texts of the plant, what was done to it and when, the moment where it stands, and what
// was set on the page. The plant does the same again, so the moment is the same one, bit by bit.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/debugger/session.hpp"
#include "tools/serve/host/arguments.hpp"
#include "tools/serve/host/outside.hpp"

namespace ipos::tools::serve {

class PlantHost;

struct Session {
  std::string plant;  // its name among the texts
  Texts texts;        // by the path from the folder of the plant; any bytes
  std::vector<debug::Change> actions;
  debug::Position moment;
  uint64_t digest = 0;  // of the state there
  Json settings = Json::object();
};

// As it stands now. A Mistake says why it cannot be kept.
Session session_of(PlantHost& host, Json settings);

std::string session_text(const Session& session);
// A Mistake says what is wrong with the text.
Session read_session(std::string_view text);

}  // namespace ipos::tools::serve
