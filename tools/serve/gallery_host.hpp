// The host of a page without a plant: it shows the examples and the plants of the folder, opens one, or makes a new one.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/serve/host/router.hpp"

namespace ipos::tools::serve {

class GalleryHost {
 public:
  struct Around {
    std::string version;
    std::string read_only;  // why no files are written; empty: they are
    std::function<std::vector<std::string>()> plants;      // those that are here, by their paths
    std::function<void(const std::string& path)> build;    // reads and compiles one; a Failure: it cannot be opened
  };
  GalleryHost(Outbox& outbox, const Clock& clock, Around around);

  void take(const Message& message) { router_.take(message); }
  // The path of the plant that was opened; empty: none yet.
  const std::string& opened() const { return opened_; }

  Router& router() { return router_; }

 private:
  Json list() const;
  Json open(const Arguments& a);
  Json make(const Arguments& a);
  void must_write() const;
  Json enter(const std::string& path);

  Router router_;
  Around around_;
  std::string opened_;
};

}  // namespace ipos::tools::serve
