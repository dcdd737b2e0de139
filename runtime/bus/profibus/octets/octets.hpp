// A row of octets, used as a vector is. Those of a frame of PROFIBUS, 255 at most, lie where the row stands, so frames,
// process images and answers take no memory of the heap; only a longer row, which no frame is, has memory of its own.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <vector>

namespace ipos::profibus {

class Octets {
 public:
  static constexpr size_t kInPlace = 255;  // SD2 with LE = 249: 68 LE LE 68 .. FCS 16

  using value_type = uint8_t;
  using size_type = size_t;
  using difference_type = std::ptrdiff_t;
  using reference = uint8_t&;
  using const_reference = const uint8_t&;
  using iterator = uint8_t*;
  using const_iterator = const uint8_t*;

  Octets() {}  // NOLINT: the octets behind the end have no value
  explicit Octets(size_t count, uint8_t value = 0) { resize(count, value); }
  Octets(std::initializer_list<uint8_t> octets) { assign(octets.begin(), octets.end()); }
  template <std::forward_iterator It>
  Octets(It first, It last) {
    assign(first, last);
  }
  // Text has them so.
  Octets(const std::vector<uint8_t>& octets) { assign(octets.begin(), octets.end()); }
  operator std::vector<uint8_t>() const { return {begin(), end()}; }
  Octets(const Octets& other) : size_(other.size_) {
    if (size_ <= kInPlace)
      std::copy_n(other.place_.begin(), size_, place_.begin());
    else
      more_ = other.more_;
  }
  Octets& operator=(const Octets& other) {
    if (this != &other) assign(other.begin(), other.end());
    return *this;
  }

  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  uint8_t* data() { return size_ <= kInPlace ? place_.data() : more_.data(); }
  const uint8_t* data() const { return size_ <= kInPlace ? place_.data() : more_.data(); }
  iterator begin() { return data(); }
  iterator end() { return data() + size_; }
  const_iterator begin() const { return data(); }
  const_iterator end() const { return data() + size_; }
  uint8_t& operator[](size_t n) {
    assert(n < size_);
    return data()[n];
  }
  const uint8_t& operator[](size_t n) const {
    assert(n < size_);
    return data()[n];
  }
  uint8_t& front() { return (*this)[0]; }
  uint8_t& back() { return (*this)[size_ - 1]; }
  const uint8_t& front() const { return (*this)[0]; }
  const uint8_t& back() const { return (*this)[size_ - 1]; }

  void clear() { size_ = 0; }
  void resize(size_t count, uint8_t value = 0) {
    const size_t before = size_;
    set_size(count);
    if (count > before) std::fill(data() + before, end(), value);
  }
  void push_back(uint8_t octet) {
    set_size(size_ + 1);
    back() = octet;
  }
  void pop_back() { set_size(size_ - 1); }
  void assign(size_t count, uint8_t value) {
    clear();
    resize(count, value);
  }
  template <std::forward_iterator It>
  void assign(It first, It last) {
    clear();
    set_size(static_cast<size_t>(std::distance(first, last)));
    std::copy(first, last, begin());
  }
  // What is inserted must not be octets of this row.
  template <std::forward_iterator It>
  iterator insert(const_iterator place, It first, It last) {
    const auto at = place - begin();
    const size_t before = size_;
    set_size(before + static_cast<size_t>(std::distance(first, last)));
    std::copy_backward(begin() + at, begin() + before, end());
    std::copy(first, last, begin() + at);
    return begin() + at;
  }
  iterator insert(const_iterator place, std::initializer_list<uint8_t> octets) {
    return insert(place, octets.begin(), octets.end());
  }
  iterator insert(const_iterator place, uint8_t octet) { return insert(place, {octet}); }
  iterator erase(const_iterator first, const_iterator last) {
    const auto at = first - begin();
    std::copy(last, const_iterator(end()), begin() + at);
    set_size(size_ - static_cast<size_t>(last - first));
    return begin() + at;
  }
  iterator erase(const_iterator place) { return erase(place, place + 1); }

  friend bool operator==(const Octets& a, const Octets& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }
  friend bool operator<(const Octets& a, const Octets& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  // Those there were stay; new ones have no value yet.
  void set_size(size_t size) {
    if (size <= kInPlace && size_ <= kInPlace)
      size_ = size;
    else
      move_to(size);
  }
  void move_to(size_t size) {
    if (size_ <= kInPlace) more_.assign(place_.begin(), place_.begin() + static_cast<std::ptrdiff_t>(size_));
    more_.resize(size);
    if (size <= kInPlace) std::copy(more_.begin(), more_.end(), place_.begin());
    size_ = size;
  }

  size_t size_ = 0;
  std::array<uint8_t, kInPlace> place_;
  std::vector<uint8_t> more_;  // all of them, when they are more
};

}  // namespace ipos::profibus
