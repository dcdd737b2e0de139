// The texts are compared before anything is written.
#include "tools/serve/opened_session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/os_file.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/serve/host/plant_host.hpp"

namespace ipos::tools::serve {
namespace {

namespace fs = std::filesystem;

std::string own_folder() {
  std::error_code error;
  const fs::path temporary = fs::temp_directory_path(error);
  const std::string name = ((error ? fs::path("/tmp") : temporary) / "ipos-session-").string();
  const auto folder = make_folder(name);
  if (!folder) throw Failure(kIoError, fmt::format("{}: no folder can be made there", name));
  return *folder;
}

}  // namespace

bool is_session(const std::string& path) { return path.ends_with(".ipos"); }

OpenedSession::OpenedSession(const std::string& path) : path_(path), owner_(getpid()) {
  try {
    session_ = sessions::read_session(read_file(path));
  } catch (const sessions::Unreadable& mistake) {
    throw Failure(kBadInput, fmt::format("{}: {}", path, mistake.what()));
  }
  const auto& texts = session_.texts;
  const fs::path beside = fs::path(path).parent_path();
  const bool same = std::all_of(texts.begin(), texts.end(), [&](const auto& file) {
    return try_read_file((beside / file.first).string()) == file.second;
  });
  if (!same) {
    folder_ = own_folder();
    for (const auto& [name, text] : texts) {
      const fs::path place = fs::path(folder_) / name;
      fs::create_directories(place.parent_path());
      replace_file(place.string(), text);
    }
  }
  place_ = (same ? beside : fs::path(folder_)).generic_string();
  plant_ = (fs::path(place_) / session_.plant).generic_string();
}

std::optional<sessions::OfTest> OpenedSession::beside() const {
  std::optional<sessions::OfTest> test = session_.test;
  if (test) test->file = (fs::path(place_) / test->file).generic_string();
  return test;
}

void OpenedSession::resume(PlantHost& host) const {
  for (const auto& [name, value] : session_.settings.items()) host.router().keep(name, value);
  try {
    host.resume(session_);
  } catch (const Mistake& mistake) {
    throw Failure(kBadInput, fmt::format("{}: {}", path_, mistake.what()));
  }
}

OpenedSession::~OpenedSession() {
  std::error_code error;
  if (!folder_.empty() && getpid() == owner_) fs::remove_all(folder_, error);
}

}  // namespace ipos::tools::serve
