// Names of the convention "structured", and where the resources lie.
#include <gtest/gtest.h>

#include "runtime/fmi/names.hpp"
#include "runtime/fmi/resources.hpp"

namespace ipos::fmi {
namespace {

TEST(FmiNames, AreStructured) {
  const struct {
    const char *owner, *signal, *name;
  } rows[] = {{"hoist", "hoist.speed", "hoist.speed"},
              {"u", "u.TrCycl.Result", "u.TrCycl.Result"},
              {"u", "u.y[12]", "u.y[12]"},
              {"u", "u.T.b[3].c", "u.T.b[3].c"},
              {"u", "u.y[1][2]", "u.'y[1][2]'"},
              {"u", "u.PO1.6", "u.'PO1.6'"},
              {"u", "u.T.b.6", "u.T.'b.6'"},
              {"u", "u.8807", "u.'8807'"},
              {"u", "u.task1.line", "u.task1.line"},
              {"v.w", "v.w.speed", "v.w.speed"},
              {"saw 1", "saw 1.speed", "'saw 1'.speed"},
              {"1st", "1st.P130", "'1st'.P130"},
              {"a.1", "a.1.speed", "'a.1'.speed"},
              {"s\xC3\xA4ge", "s\xC3\xA4ge.speed", "'s{C3}{A4}ge'.speed"},
              {"it's", "it's.speed", "'it{27}s'.speed"},
              {"sbus", "sbus.013.PO1", "sbus.'013'.PO1"}};
  for (const auto& row : rows) EXPECT_EQ(structured_name(row.owner, row.signal), row.name);
}

TEST(FmiResources, AreFoundByTheirUri) {
  EXPECT_EQ(folder_of_uri("file:///tmp/a/resources"), "/tmp/a/resources");
  EXPECT_EQ(folder_of_uri("file:/tmp/a"), "/tmp/a");
  EXPECT_EQ(folder_of_uri("file://localhost/tmp/a"), "/tmp/a");
  EXPECT_EQ(folder_of_uri("file:///tmp/a%20b/%C3%BC%25"), "/tmp/a b/\xC3\xBC%");
  EXPECT_EQ(folder_of_uri("file:///tmp/50%"), "/tmp/50%");
  EXPECT_EQ(folder_of_uri("file:///C:/a"), "C:/a");
  EXPECT_EQ(folder_of_uri("/tmp/a b"), "/tmp/a b") << "some importers hand over a path";
  EXPECT_EQ(folder_of_uri("http://somewhere/a"), "");
  EXPECT_EQ(folder_of_uri("file://elsewhere/a"), "");
}

}  // namespace
}  // namespace ipos::fmi
