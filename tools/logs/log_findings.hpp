// What a verb tells about a log that it reads, on standard error: mistakes with their places, and at the end how much was left
// out. Of equal mistakes the first twenty are printed; a file of which nothing is understood gets one message.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/logs/left_out.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tools {

class LogFindings {
 public:
  static constexpr size_t kMostEqual = 20;  // mistakes of one text that are printed (ours)

  explicit LogFindings(std::string path) : path_(std::move(path)) {}
  LogFindings(const LogFindings&) = delete;
  LogFindings& operator=(const LogFindings&) = delete;

  // The reader whose mistakes, notes and omissions are told here. This must outlive it.
  LogReader watch(LogReader reader);
  void wrong(LogPlace place, const std::string& message);
  void leave_out(LeftOut what);
  // Of the log as a whole.
  void note(const std::string& text);

  // Once, at the end. Whether all of the log was understood.
  bool finish();
  // Whether anything was: if not, there is nothing to show.
  bool understood() const { return understood_; }
  const LeftOutCounts& left_out() const { return left_out_; }

 private:
  void understand();
  void print_waiting();
  void print(const std::string& line) const;

  std::string path_;
  LeftOutCounts left_out_;
  std::map<std::string, size_t> told_;  // mistakes by their text
  std::vector<std::string> waiting_;    // mistakes before anything is understood
  size_t mistakes_ = 0;
  bool binary_ = false;  // the mistakes have bytes for places
  bool understood_ = false;
};

}  // namespace ipos::tools
