// The place at which a real-time run can be looked at by its own user and nobody else: on Linux a socket in a folder that is
// this user's alone, on Windows a port of the loopback with a word that stands in a file of the user. posix and windows have
// a source each.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace ipos::tools::debug {

// A stream of bytes to the other side. Nothing here waits.
class Peer {
 public:
  virtual ~Peer() = default;
  // Appends what has come. False: the other side has gone.
  virtual bool receive(std::string& bytes) = 0;
  // Sends what can be sent at once, and takes it away. False: the other side has gone.
  virtual bool send(std::string& bytes) = 0;
};

// Of the run.
class AttachPort {
 public:
  virtual ~AttachPort() = default;
  virtual std::unique_ptr<Peer> accept() = 0;  // null: nobody has come
  // What a peer must say before anything else; empty where the system itself keeps others out.
  virtual const std::string& word() const = 0;
};

// `name` tells runs apart for people. Null: this user has no such place.
std::unique_ptr<AttachPort> open_attach_port(const std::string& name);

struct AttachableRun {
  int64_t process = 0;
  std::string name;
  std::string place;  // a path, or a port and the word
};

// In the order of their processes; of those that have ended without a word nothing is left.
std::vector<AttachableRun> attachable_runs();

// Null: it has gone. What the run wants to hear first has been said.
std::unique_ptr<Peer> attach_to(const AttachableRun& run);

}  // namespace ipos::tools::debug
