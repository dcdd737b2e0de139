// A port of the loopback. Every user of the computer reaches it, so a peer says a word first that only this user can read: it
// stands in %LOCALAPPDATA%\ipos, which belongs to one user, beside the number of the port.
#include "tools/debug/attach_port.hpp"

#include <fmt/format.h>
#include <winsock2.h>

#include <windows.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <utility>

namespace ipos::tools::debug {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".attach";

std::optional<fs::path> folder() {
  const wchar_t* const local = _wgetenv(L"LOCALAPPDATA");
  if (local == nullptr || !fs::path(local).is_absolute()) return std::nullopt;
  std::error_code error;
  const fs::path at = fs::path(local) / "ipos" / "runs";
  fs::create_directories(at, error);
  return fs::is_directory(at, error) ? std::optional(at) : std::nullopt;
}

bool started() {
  static const bool good = [] {
    WSADATA data{};
    return WSAStartup(MAKEWORD(2, 2), &data) == 0;
  }();
  return good;
}

class Socket {
 public:
  explicit Socket(SOCKET socket) : socket_(socket) {}
  ~Socket() {
    if (socket_ != INVALID_SOCKET) closesocket(socket_);
  }
  Socket(Socket&& other) noexcept : socket_(std::exchange(other.socket_, INVALID_SOCKET)) {}
  Socket& operator=(Socket&&) = delete;
  SOCKET get() const { return socket_; }
  bool is_open() const { return socket_ != INVALID_SOCKET; }
  void never_wait() const {
    u_long on = 1;
    ioctlsocket(socket_, FIONBIO, &on);
  }

 private:
  SOCKET socket_;
};

class SocketPeer final : public Peer {
 public:
  explicit SocketPeer(Socket socket) : socket_(std::move(socket)) { socket_.never_wait(); }

  bool receive(std::string& bytes) override {
    char part[16384];
    for (;;) {
      const int count = ::recv(socket_.get(), part, sizeof part, 0);
      if (count > 0)
        bytes.append(part, static_cast<size_t>(count));
      else
        return count != 0 && WSAGetLastError() == WSAEWOULDBLOCK;
    }
  }

  bool send(std::string& bytes) override {
    while (!bytes.empty()) {
      const int count = ::send(socket_.get(), bytes.data(), static_cast<int>(std::min<size_t>(bytes.size(), 65536)), 0);
      if (count < 0) return WSAGetLastError() == WSAEWOULDBLOCK;
      bytes.erase(0, static_cast<size_t>(count));
    }
    return true;
  }

 private:
  Socket socket_;
};

class SocketPort final : public AttachPort {
 public:
  SocketPort(Socket socket, fs::path file, std::string word) : socket_(std::move(socket)), file_(std::move(file)), word_(std::move(word)) {}
  ~SocketPort() override {
    std::error_code error;
    fs::remove(file_, error);
  }
  SocketPort(const SocketPort&) = delete;
  SocketPort& operator=(const SocketPort&) = delete;

  std::unique_ptr<Peer> accept() override {
    Socket come(::accept(socket_.get(), nullptr, nullptr));
    return come.is_open() ? std::make_unique<SocketPeer>(std::move(come)) : nullptr;
  }
  const std::string& word() const override { return word_; }

 private:
  Socket socket_;
  fs::path file_;
  std::string word_;
};

sockaddr_in loopback(uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

}  // namespace

std::unique_ptr<AttachPort> open_attach_port(const std::string& name) {
  const auto in = folder();
  if (!in || !started()) return nullptr;
  Socket socket(::socket(AF_INET, SOCK_STREAM, 0));
  if (!socket.is_open()) return nullptr;
  const BOOL on = TRUE;
  setsockopt(socket.get(), SOL_SOCKET, SO_EXCLUSIVEADDRUSE, reinterpret_cast<const char*>(&on), sizeof on);
  sockaddr_in address = loopback(0);
  int size = sizeof address;
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || ::listen(socket.get(), 4) != 0 ||
      getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0)
    return nullptr;
  socket.never_wait();
  std::random_device chance;  // of the system
  std::string word;
  for (int n = 0; n < 4; ++n) word += fmt::format("{:08x}", chance());
  std::string plain = name.substr(0, 40);
  std::replace_if(plain.begin(), plain.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '_'; }, '_');
  const fs::path file = *in / fmt::format("{}-{}{}", GetCurrentProcessId(), plain, kEnding);
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << ntohs(address.sin_port) << ' ' << word;
  out.close();
  if (!out) return nullptr;
  return std::make_unique<SocketPort>(std::move(socket), file, word);
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
    const HANDLE process = OpenProcess(PROCESS_QUERY_LIMITED_INFORMATION, FALSE, static_cast<DWORD>(run.process));
    if (process == nullptr && GetLastError() == ERROR_INVALID_PARAMETER) {  // there is none of this number
      fs::remove(entry.path(), error);
      continue;
    }
    if (process != nullptr) CloseHandle(process);
    run.name = std::string(end + 1, file.data() + file.size() - std::string_view(kEnding).size());
    std::ifstream text(entry.path(), std::ios::binary);
    std::stringstream whole;
    whole << text.rdbuf();
    run.place = whole.str();
    all.push_back(std::move(run));
  }
  std::sort(all.begin(), all.end(), [](const AttachableRun& a, const AttachableRun& b) { return a.process < b.process; });
  return all;
}

std::unique_ptr<Peer> attach_to(const AttachableRun& run) {
  unsigned port = 0;
  std::string word;
  std::istringstream(run.place) >> port >> word;
  if (!started() || port == 0 || port > 65535) return nullptr;
  Socket socket(::socket(AF_INET, SOCK_STREAM, 0));
  const sockaddr_in address = loopback(static_cast<uint16_t>(port));
  if (!socket.is_open() || ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return nullptr;
  auto peer = std::make_unique<SocketPeer>(std::move(socket));
  std::string first = word + "\n";
  return peer->send(first) && first.empty() ? std::move(peer) : nullptr;
}

}  // namespace ipos::tools::debug
