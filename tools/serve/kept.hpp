// What `ipos serve` keeps of one plant or drive from start to start, in the user's state folder: the token and the port, so
// that tabs of the time before find their server again, and what a person has set on the page.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "tools/serve/host/router.hpp"

namespace ipos::tools::serve {

class Kept {
 public:
  // Of a plant file, or of a real drive by its line and address.
  static Kept of_plant(const std::string& file);
  static Kept of_drive(const std::string& port, const std::string& address);

  // The one of the time before, else a new one. Where it cannot be kept each start has its own.
  std::string token() const;
  std::optional<uint16_t> port() const;
  void keep_port(uint16_t port) const;
  // Those of host/settings.hpp. Each reads and writes the file: another server may have the
  // same plant.
  void add_commands(Router& router) const;
  Json settings() const;  // by name

 private:
  explicit Kept(std::string of);
  Json read() const;
  // The server and the host are two processes with one file, and another server may have the same plant: who changes it
  // keeps the others waiting, so that nothing is lost between reading and writing. False: it cannot be kept.
  bool change(const std::function<void(Json&)>& act) const;

  std::string name_;  // of the file
};

}  // namespace ipos::tools::serve
