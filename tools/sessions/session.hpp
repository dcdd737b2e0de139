// A session as a file, NAME.ipos: the texts of the plant, what was done to it and when, the moment where it stands, and what
// was set on the page. The plant does the same again, so the moment is the same one, bit by bit.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tools/debugger/session.hpp"

namespace ipos::tools::sessions {

using debug::Json;
using Texts = std::map<std::string, std::string>;

// A text that is no session, or one that cannot be read; for a person.
class Unreadable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The test whose script runs beside the plant.
struct OfTest {
  std::string file;       // its name among the texts
  std::string test_case;  // empty: the file has one only
  uint64_t seed = 0;
  uint32_t speed = 0;  // as --speed of `ipos test`

  NLOHMANN_DEFINE_TYPE_INTRUSIVE(OfTest, file, test_case, seed, speed)
};

struct Session {
  std::string plant;  // its name among the texts; a test may have its plant in itself
  std::optional<OfTest> test;
  Texts texts;  // by the path from the folder of the session; any bytes
  std::vector<debug::Change> actions;
  debug::Position moment;
  uint64_t digest = 0;  // of the state there
  Json settings = Json::object();
};

// A name of a text: a path that stays in the folder.
bool is_inside(const std::string& name);

// The folder that has all these files, and the name of a file in it.
std::string common_folder(const std::vector<std::string>& files);
std::string name_in(const std::string& folder, const std::string& file);

std::string session_text(const Session& session);
// Throws Unreadable.
Session read_session(std::string_view text);

}  // namespace ipos::tools::sessions
