// The plant of plants.hpp and a page without a browser.
#pragma once

#include <gtest/gtest.h>

#include "tests/serve/plants.hpp"
#include "tests/serve/served_page.hpp"

namespace ipos::tests {

class Serving : public ::testing::Test {
 protected:
  Json good(Json message) {
    Json reply = page.ask(std::move(message));
    EXPECT_TRUE(reply.value("ok", false)) << reply;
    return reply;
  }
  std::string error(Json message) { return page.ask(std::move(message)).value("error", "no error"); }
  Json step(int ms) { return good({{"do", "step"}, {"ms", ms}}); }
  // The whole state of a topic.
  Json topic(Json message) {
    message["do"] = "subscribe";
    good(message);
    const std::string name = message["topic"];
    return page.event(name);
  }
  int64_t value(const std::string& name) {
    good({{"do", "watch"}, {"names", {name}}});
    return topic({{"topic", "watch"}})["values"].front()["value"].get<int64_t>();
  }

  explicit Serving(tools::debug::MakePlant make = the_plant(), bool copied = true) : page(std::move(make), copied) {}

  ServedPage page;
};

}  // namespace ipos::tests
