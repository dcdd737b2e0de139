// The physical quantities by their index as 1053 1610 chapter 7.3 prints them, 0 and up.
#pragma once

namespace ipos::tests {

inline constexpr const char* kPrintedQuantities[] = {"dimensionless",
                                                     "length",
                                                     "area",
                                                     "volume",
                                                     "time",
                                                     "force",
                                                     "pressure",
                                                     "mass",
                                                     "energy, work",
                                                     "effective power",
                                                     "apparent power",
                                                     "rotational velocity",
                                                     "angle",
                                                     "speed",
                                                     "volume rate of flow",
                                                     "mass rate of flow",
                                                     "torque",
                                                     "temperature",
                                                     "temperature difference",
                                                     "entropy",
                                                     "enthalpy",
                                                     "electrical voltage",
                                                     "electrical current",
                                                     "electrical resistance",
                                                     "ratio",
                                                     "relative humidity",
                                                     "absolute humidity",
                                                     "relative change",
                                                     "frequency"};

}  // namespace ipos::tests
