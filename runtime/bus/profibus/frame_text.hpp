// A frame in words, for bus logs and people: who asks whom for what, with the data of the DP services taken
// apart.
#pragma once

#include <string>
#include <string_view>

#include "runtime/bus/profibus/dp_service.hpp"
#include "runtime/bus/profibus/fdl_frame.hpp"

namespace ipos::profibus {

// "1 -> 8 Set_Prm, SRD high, FCB 1: lock, sync, watchdog 0.2 s, min Tsdr 11, ident 3100h, groups 00h"; with `data` in place of
// the frame's own, where somebody knows better what they mean.
std::string describe(const FdlFrame& frame, std::string_view data = {});

// It carries process data: no access points.
bool is_data_exchange(const FdlFrame& frame);

// What the frames of one kind have in common, without counts and data: "1 -> 8 Set_Prm", "8 -> 1 Slave_Diag answer",
// "1 -> 1 token".
std::string frame_kind(const FdlFrame& frame);

// "0.2 s"
std::string describe_watchdog(const PrmData& prm);

// "Station_Not_Ready, Prm_Req; master none, ident 3100h"
std::string describe(const Diagnosis& diagnosis);

// "68 05 05 68 ..", the octets of a frame or of its data.
std::string hex_text(std::span<const uint8_t> octets);

}  // namespace ipos::profibus
