// A pseudo-terminal whose other end is linked at a path of the user's choice, so that any program that opens
// a serial device can attach. The link goes when the owner does.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <tl/expected.hpp>

#include "runtime/os_port/descriptor.hpp"
#include "runtime/os_port/out_bytes.hpp"
#include "runtime/os_port/port.hpp"

namespace ipos::runtime {

class Pty {
 public:
  // A link that a run holds is an error. Another one to a pseudo-terminal, or to nothing, is left over from
  // an earlier run and replaced (ours); anything else at `path` is an error. At most `limit` bytes wait to be
  // written.
  static tl::expected<Pty, PortError> create(const std::string& path, size_t limit);
  ~Pty();
  Pty(Pty&&) = default;
  Pty& operator=(Pty&&) = delete;

  // Number of bytes read, 0 when there are none now.
  size_t read(std::span<char> into);

  // Whether a program has the other end open, as the last read() saw it.
  bool is_attached() const { return attached_; }

  // What a port says of that.
  std::string_view absence() const {
    return attached_ ? std::string_view() : "no program has its other end open";
  }

  // False when there is no room. Without a program attached the bytes go nowhere, as on a line with nobody on
  // it.
  bool write(std::string_view bytes);
  void flush();
  std::string_view waiting() const { return out_.waiting(); }

  // Nothing to poll while nobody is attached: the system would report the open end without pause.
  PortNeeds needs() const { return {attached_ ? master_.get() : -1, !out_.empty(), kNever}; }

  const std::string& path() const { return path_; }

 private:
  Pty(std::string path, std::string device, Descriptor lock, Descriptor master, size_t limit)
      : path_(std::move(path)),
        device_(std::move(device)),
        lock_(std::move(lock)),
        master_(std::move(master)),
        out_(limit) {}

  void renew_speed();

  std::string path_;
  std::string device_;  // "/dev/pts/3"; empty once moved from
  Descriptor lock_;     // of the path
  Descriptor master_;
  OutBytes out_;
  bool attached_ = false;
  bool second_mark_ = false;  // which of two speeds was set last
};

}  // namespace ipos::runtime
