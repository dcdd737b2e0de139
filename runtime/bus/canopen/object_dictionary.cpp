// Rows of objects.def, and the values of a node.
#include "runtime/bus/canopen/object_dictionary.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime::canopen {
namespace {

constexpr ObjectRow kObjects[] = {
#define OBJECT(index, kind, name) {index, ObjectKind::kind, name},
#include "runtime/bus/canopen/objects.def"
};

constexpr EntryRow kEntries[] = {
#define ENTRY(index, sub, subs, name, type, access, value, step, own, rule) \
  {index, sub, subs, name, DataType::type, Access::access, value, step, own, Rule::rule},
#include "runtime/bus/canopen/objects.def"
};

}  // namespace

std::span<const ObjectRow> object_rows() { return kObjects; }
std::span<const EntryRow> entry_rows() { return kEntries; }

const ObjectRow* find_object(uint16_t index) {
  const auto* const found = std::find_if(std::begin(kObjects), std::end(kObjects),
                                         [&](const ObjectRow& row) { return row.index == index; });
  return found == std::end(kObjects) ? nullptr : found;
}

std::string entry_name(Address address) {
  for (const EntryRow& row : kEntries) {
    if (row.index != address.index || address.sub < row.sub || address.sub >= row.sub + row.subs) continue;
    if (row.subs == 1) return std::string(row.name);
    const bool word = row.rule == Rule::Output || row.rule == Rule::Input;
    return fmt::format("{}{}{}", row.name, word ? "" : " ", address.sub);
  }
  return {};
}

ObjectDictionary::ObjectDictionary(uint8_t node) : node_(node) {
  restore();
  outputs_ = static_cast<size_t>(find({objects::kOutput, 1}) - entries_.data());
}

void ObjectDictionary::restore() {
  static const std::vector<Entry> kDefaults = defaults();
  entries_ = kDefaults;
  for (Entry& entry : entries_)
    if (entry.row->own) entry.value += node_;
}

std::vector<ObjectDictionary::Entry> ObjectDictionary::defaults() {
  std::vector<Entry> entries;
  for (const EntryRow& row : kEntries)
    for (uint8_t n = 0; n < row.subs; ++n) {
      const auto sub = static_cast<uint8_t>(row.sub + n);
      entries.push_back({{row.index, sub}, &row, row.default_of(sub)});
    }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.address < b.address; });
  return entries;
}

const ObjectDictionary::Entry* ObjectDictionary::find(Address address) const {
  const auto found =
      std::lower_bound(entries_.begin(), entries_.end(), address,
                       [](const Entry& entry, const Address& wanted) { return entry.address < wanted; });
  return found == entries_.end() || found->address != address ? nullptr : &*found;
}

void ObjectDictionary::set(Address address, uint32_t value) {
  entries_[static_cast<size_t>(find(address) - entries_.data())].value = value;
}

void ObjectDictionary::set_outputs(const std::array<uint16_t, objects::kProcessWords>& words, uint16_t which) {
  each_word(which, [&](size_t n) { entries_[outputs_ + n].value = words[n]; });
}

}  // namespace ipos::runtime::canopen
