// A session that `ipos serve NAME.ipos` opens: its texts as files, in the folder of the session where they stand there as they
// were, else in a folder of their own that goes with the server.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "tools/sessions/session.hpp"

namespace ipos::tools::serve {

class PlantHost;

bool is_session(const std::string& path);  // NAME.ipos
// Why the files of one that is unpacked are not written.
inline constexpr const char* kFilesOfSession = "these are the files of a session, as they were when it was saved";

class OpenedSession {
 public:
  // A Failure says what is wrong with the file.
  explicit OpenedSession(const std::string& path);
  // In the process that has opened it.
  ~OpenedSession();
  OpenedSession(const OpenedSession&) = delete;
  OpenedSession& operator=(const OpenedSession&) = delete;

  const std::string& path() const { return path_; }
  // The moment and the settings of the session; before the first turn. A Failure: the plant does not come to that moment.
  void resume(PlantHost& host) const;
  const std::string& plant() const { return plant_; }  // the path of its file
  std::optional<sessions::OfTest> beside() const;  // the test whose script runs beside it; the path of its file
  bool is_unpacked() const { return !folder_.empty(); }

 private:
  std::string path_;
  sessions::Session session_;
  std::string plant_;
  std::string place_;  // the folder of its texts
  std::string folder_;  // of its own
  pid_t owner_;
};

}  // namespace ipos::tools::serve
