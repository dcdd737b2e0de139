// Sockets in the file system: $XDG_RUNTIME_DIR/ipos, else /tmp/ipos-USER, a folder of mode 0700 that belongs to this user.
#include "tools/debug/attach_port.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>

#include "runtime/os_port/descriptor.hpp"

namespace ipos::tools::debug {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".attach";

// Nothing where the folder cannot be made, or is one that others could write into.
std::optional<fs::path> folder() {
  const char* const runtime = std::getenv("XDG_RUNTIME_DIR");
  const fs::path at = runtime != nullptr && fs::path(runtime).is_absolute() ? fs::path(runtime) / "ipos"
                                                                           : fs::path(fmt::format("/tmp/ipos-{}", geteuid()));
  if (mkdir(at.c_str(), 0700) != 0 && errno != EEXIST) return std::nullopt;
  struct stat info {};
  if (lstat(at.c_str(), &info) != 0 || !S_ISDIR(info.st_mode) || info.st_uid != geteuid() || (info.st_mode & 0077U) != 0)
    return std::nullopt;
  return at;
}

std::optional<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return std::nullopt;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

class SocketPeer final : public Peer {
 public:
  explicit SocketPeer(runtime::Descriptor socket) : socket_(std::move(socket)) {}

  bool receive(std::string& bytes) override {
    char part[16384];
    for (;;) {
      const ssize_t count = recv(socket_.get(), part, sizeof part, MSG_DONTWAIT);
      if (count > 0)
        bytes.append(part, static_cast<size_t>(count));
      else if (count == 0 || (errno != EAGAIN && errno != EINTR))
        return false;
      else if (errno == EAGAIN)
        return true;
    }
  }

  bool send(std::string& bytes) override {
    while (!bytes.empty()) {
      const ssize_t count = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
      if (count >= 0)
        bytes.erase(0, static_cast<size_t>(count));
      else if (errno == EAGAIN)
        return true;
      else if (errno != EINTR)
        return false;
    }
    return true;
  }

 private:
  runtime::Descriptor socket_;
};

class SocketPort final : public AttachPort {
 public:
  SocketPort(runtime::Descriptor socket, std::string path) : socket_(std::move(socket)), path_(std::move(path)), process_(getpid()) {}
  ~SocketPort() override {
    if (getpid() == process_) unlink(path_.c_str());
  }
  SocketPort(const SocketPort&) = delete;
  SocketPort& operator=(const SocketPort&) = delete;

  // The folder keeps others out; who comes is looked at all the same.
  std::unique_ptr<Peer> accept() override {
    runtime::Descriptor come(accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    ucred who{};
    socklen_t size = sizeof who;
    if (!come.is_open() || getsockopt(come.get(), SOL_SOCKET, SO_PEERCRED, &who, &size) != 0 || who.uid != geteuid()) return nullptr;
    return std::make_unique<SocketPeer>(std::move(come));
  }
  const std::string& word() const override { return word_; }

 private:
  runtime::Descriptor socket_;
  std::string path_, word_;
  pid_t process_;
};

}  // namespace

std::unique_ptr<AttachPort> open_attach_port(const std::string& name) {
  const auto in = folder();
  if (!in) return nullptr;
  std::string plain = name.substr(0, 40);
  std::replace_if(plain.begin(), plain.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '_'; }, '_');
  const std::string path = (*in / fmt::format("{}-{}{}", getpid(), plain, kEnding)).string();
  const auto address = address_of(path);
  runtime::Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!address || !socket.is_open()) return nullptr;
  unlink(path.c_str());  // of a process that had the number before
  if (bind(socket.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0) return nullptr;
  chmod(path.c_str(), 0600);
  if (listen(socket.get(), 4) != 0) {
    unlink(path.c_str());
    return nullptr;
  }
  return std::make_unique<SocketPort>(std::move(socket), path);
}

std::vector<AttachableRun> attachable_runs() {
  std::vector<AttachableRun> all;
  const auto in = folder();
  if (!in) return all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(*in, error)) {
    const std::string file = entry.path().filename().string();
    AttachableRun run;
    const auto [end, status] = std::from_chars(file.data(), file.data() + file.size(), run.process);
    if (status != std::errc() || end == file.data() + file.size() || *end != '-' || !file.ends_with(kEnding)) continue;
    if (kill(static_cast<pid_t>(run.process), 0) != 0 && errno == ESRCH) {
      fs::remove(entry.path(), error);
      continue;
    }
    run.name = std::string(end + 1, file.data() + file.size() - std::strlen(kEnding));
    run.place = entry.path().string();
    all.push_back(std::move(run));
  }
  std::sort(all.begin(), all.end(), [](const AttachableRun& a, const AttachableRun& b) { return a.process < b.process; });
  return all;
}

std::unique_ptr<Peer> attach_to(const AttachableRun& run) {
  const auto address = address_of(run.place);
  runtime::Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!address || !socket.is_open() || connect(socket.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0)
    return nullptr;
  return std::make_unique<SocketPeer>(std::move(socket));
}

}  // namespace ipos::tools::debug
