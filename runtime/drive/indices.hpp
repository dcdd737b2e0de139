// Indices of the parameters the drive itself acts on (1053 1610 p. 68-83). Only those: all others are data in
// stdlib/parameters.
#pragma once

#include <cstdint>

#include "stdlib/index_areas.hpp"

namespace ipos::runtime::index {

inline constexpr uint16_t kPo1Description = 8304;  // P870..P872
inline constexpr uint16_t kPi1Description = 8307;  // P873..P875
inline constexpr uint16_t kFirmware = stdlib::kFirmwareIndex;  // P076
inline constexpr uint16_t kUnitType = 8301;                        // P070
inline constexpr uint16_t kStatus = 8310;                          // P010..P013, low word is status word 1
inline constexpr uint16_t kSpeed = 8318;
inline constexpr uint16_t kFrequency = 8319;
inline constexpr uint16_t kActualPosition = 8320;
inline constexpr uint16_t kOutputCurrent = 8321;
inline constexpr uint16_t kActiveCurrent = 8322;
inline constexpr uint16_t kMotorUtilization1 = 8323;
inline constexpr uint16_t kMotorUtilization2 = 8324;
inline constexpr uint16_t kDcLink = 8325;
inline constexpr uint16_t kOutputCurrentAmpere = 8326;  // P009
inline constexpr uint16_t kHeatSink = 8327;
inline constexpr uint16_t kMainsOnTime = 8328;          // P015, minutes
inline constexpr uint16_t kEnabledTime = 8329;          // P016, minutes
inline constexpr uint16_t kEnergy = 8330;               // P017
inline constexpr uint16_t kInputs = 8334;               // P036, DI00..DI05
inline constexpr uint16_t kInputFunction = 8334;        // + n = function of DI0n, n = 1..5
inline constexpr uint16_t kOptionInputFunction = 8340;  // + n = function of DI1n
inline constexpr uint16_t kOptionInputs = 8348;         // P048, DI10..DI17
inline constexpr uint16_t kAnalogInput1 = 8331;         // P020, P021, P022
inline constexpr uint16_t kAnalogInput2 = 8332;
inline constexpr uint16_t kUserDisplay = 8501;  // P001
inline constexpr uint16_t kExternalLimit = 8333;
inline constexpr uint16_t kOutputs = 8349;
inline constexpr uint16_t kOutputFunction = 8350;        // + n = function of DO01, DO02
inline constexpr uint16_t kOptionOutputFunction = 8352;  // + n = function of DO10..DO17
inline constexpr uint16_t kOptionOutputs = 8360;
inline constexpr uint16_t kRatedCurrent = 8361;     // P071
inline constexpr uint16_t kPoShown = 8455;          // P094..P096
inline constexpr uint16_t kPiShown = 8458;          // P097..P099
inline constexpr uint16_t kSetpointSource = 8461;   // P100
inline constexpr uint16_t kControlSource = 8462;    // P101
inline constexpr uint16_t kFactorySetting = 8594;   // P802
inline constexpr uint16_t kParameterLock = 8595;    // P803
inline constexpr uint16_t kResetStatistics = 8596;  // P804
inline constexpr uint16_t kManualReset = 8617;      // P840
inline constexpr uint16_t kPoEnable = 8622;         // P876
inline constexpr uint16_t kScopeControl = 8950;     // these are ours
inline constexpr uint16_t kScopeState = 8951;
inline constexpr uint16_t kScopeChannel = 8952;  // + n = channel n + 1, n = 0..3
inline constexpr uint16_t kScopeTime = 8956;
inline constexpr uint16_t kScopeTrigger = 8957;
inline constexpr uint16_t kScopeLevel = 8958;
inline constexpr uint16_t kScopeBefore = 8959;
inline constexpr uint16_t kScopeSamples = 8960;
inline constexpr uint16_t kScopeRecorded = 8961;
inline constexpr uint16_t kScopePosition = 8962;
inline constexpr uint16_t kScopeValue = 8963;

inline constexpr uint16_t kOption1 = 8362;          // P072
inline constexpr uint16_t kFieldbusType = 8452;     // P091
inline constexpr uint16_t kFieldbusBaud = 8453;     // P092
inline constexpr uint16_t kFieldbusAddress = 8454;  // P093
inline constexpr uint16_t kFieldbusTimeout = 8606;  // P819

// MOVITRAC 31 (stdlib/parameters/mc31.tsv).
inline constexpr uint16_t kM31RampUp = 25;            // P120
inline constexpr uint16_t kM31Timeout = 116;          // P571
inline constexpr uint16_t kM31Terminal42 = 120;       // P600
inline constexpr uint16_t kM31Terminal43 = 121;       // P601
inline constexpr uint16_t kM31SaveEeprom = 164;       // P802
inline constexpr uint16_t kM31ControlMode = 175;      // P841
inline constexpr uint16_t kM31Address = 18;           // P073
inline constexpr uint16_t kM31Position = 200;

}  // namespace ipos::runtime::index
