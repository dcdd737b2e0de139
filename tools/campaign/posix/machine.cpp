// Processes and files of POSIX.
#include "tools/campaign/machine.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "tools/cli/failure.hpp"

namespace ipos::tools::campaign {
namespace {

std::string line_of(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

// When the process began, in ticks of its machine; empty where there is none. Its name is in brackets and may have any letters.
std::string start_of(const std::string& process) {
  const std::string line = line_of("/proc/" + process + "/stat");
  const size_t name = line.rfind(')');
  if (name == std::string::npos) return "";
  std::istringstream fields(line.substr(name + 1));
  std::string field;
  for (int n = 3; n <= 22; ++n) fields >> field;
  return field;
}

// The name of the host, the number of its boot, and the space in which processes have their numbers.
std::string this_machine() {
  utsname host{};
  uname(&host);
  char space[64] = "";
  const ssize_t length = readlink("/proc/self/ns/pid", space, sizeof space - 1);
  return fmt::format("{}/{}/{}", host.nodename, line_of("/proc/sys/kernel/random/boot_id"),
                     std::string_view(space, static_cast<size_t>(std::max<ssize_t>(length, 0))));
}

std::string name_of(pid_t process) {
  return fmt::format("{} {} {}", this_machine(), process, start_of(std::to_string(process)));
}

}  // namespace

std::string this_process() { return name_of(getpid()); }

bool is_own_process(const std::string& name) { return name == this_process(); }

std::optional<bool> is_alive(const std::string& name) {
  std::istringstream fields(name);
  std::string machine, process, start;
  fields >> machine >> process >> start;
  if (machine != this_machine()) return std::nullopt;
  return start_of(process) == start && !start.empty();
}

bool write_whole(const runtime::Descriptor& file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = write(file.get(), bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes.remove_prefix(static_cast<size_t>(done));
  }
  return true;
}

runtime::Descriptor open_to_append(const std::string& path) {
  return runtime::Descriptor(open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
}

bool cut(const runtime::Descriptor& file, size_t size) { return ftruncate(file.get(), static_cast<off_t>(size)) == 0; }

bool bring_to_disk(const runtime::Descriptor& file) { return fsync(file.get()) == 0; }

void bring_folder_to_disk(const std::string& folder) {
  const runtime::Descriptor there(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (there.is_open()) fsync(there.get());
}

// In this one's place, so that signals reach it.
int run_again(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"ipos"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv("/proc/self/exe", pointers.data());
  throw Failure(kIoError, fmt::format("ipos cannot be started again: {}", std::strerror(errno)));
}

}  // namespace ipos::tools::campaign
