// Programs as people write them, as parts to draw from: every kind of value (telegram, input, parameter, process data, timer,
// system variable), read, compared, latched, counted or forwarded, in every kind of loop. In all of them K and L are
// replaced by numbers (numbered()).
#pragma once

namespace ipos::tests {

inline constexpr const char* kReadingHead = R"(
#include <constb.h>
#pragma globals 320 399
SCTRCYCL Tr; long t1; long t2;
SCTRACYCL Ta; long s1; long s2;
SCREC Re; long r1; long r2;
MOVLNK Ml; MLDATA Md;
GSPODATA3 Po;
VARINT Vi;
long a; long b; long n; long m; long old; long hits; long v[8];
Look() { if (r1 > b) b = r1; if (r2 & 1) n = n + 1; }
Clock() { hits = hits + 1; }
Event() { hits = hits + 1; old = Vi.IntEvent; }
)";

// What is read, and what fetches it. K and L are replaced by numbers.
struct Reading {
  const char* fetch;
  const char* value;
};
inline constexpr Reading kTelegrams[] = {
    {"", "r1"}, {"", "r1"}, {"", "r2"}, {"", "(r1 & 7)"}, {"", "(r1 + r2)"}};
inline constexpr Reading kReadings[] = {
    {"", "(H483 & L)"},
    {"", "((H483 >> L) & 1)"},
    {"_MoviLink(Ml);", "Md.ReadPar"},
    {"_MoviLink(Ml);", "Md.PI2"},
    {"_GetSys(Po, GS_PODATA);", "Po.PO2"},
    {"_GetSys(a, GS_ACTSPEED);", "a"},
    {"_GetSys(a, GS_SEN);", "a"},
    {"", "H511"},
    {"", "H492"},
    {"", "H473"},
    {"", "H482"},
    {"", "H488"},
    {"if (H488 == 0) H488 = K;", "H488"},
    {"", "hits"},
    {"", "t1"},
    {"", "v[L & 7]"},
    {"a = numof(r1) + (n & 1);", "*a"},
};

// What is done with it; F stands for what fetches it, V for the value.
inline constexpr const char* kUses[] = {
    "F b = V;",
    "F b = V; old = V;",
    "F if (V > b) b = V;",
    "F if (V != old) { old = V; n = n + 1; }",
    "F if (V & L) b = 1;",
    "F if ((V & 1) && !old) n = n + 1; old = V & 1;",
    "F if (V == L) n = n + 1;",
    "F if (V < L * 100) b = b | 1; else b = b & ~1;",
    "F n = n + 1; b = V;",
    "F b = b + (V - b) / 4;",
    "F t1 = V;",
    "F t1 = V * 3 - 1; t2 = n;",
    "F H481 = V;",
    "F if (V) SETOUT else CLEAROUT",
    "F if (V != old) { old = V; s1 = V; _SBusCommDef(SCD_TRACYCL, Ta); }",
    "F _GoAbs(GO_NOWAIT, V);",
    "F a = V & 4095; _SetSys(SS_N11, a);",
    "do { F } while (V < L * 50); n = n + 1; _Wait(K);",
    "do { F } while (V & L); n = n + 1;",
    "F switch (V & 3) { case 0: b = 1; break; case 1: b = 2; n = n + 1; break; default: b = 0; }",
    "F v[V & 7] = n;",
    "F b = v[V & 7];",
    "F a = numof(v[0]) + (V & 7); *a = V;",
    "F b = V & 3; if (b == 3) n = n + 1;",
    "F b = V; for (m = 0; m < L; m++) b = b * 2;",
    "F _Copy(v[1], v[0], L & 3 | 1); v[0] = V;",
    "F if (V > K) { b = 1; } else if (V > L) { b = 2; } else { b = 3; }",
    "F b = V; Look();",
    "Look();",
    "F b = V ? V : b;",
    "",
};

// Of a unit that does nothing but circle round a telegram, without a wait: it runs ahead of the others or is idle between two
// telegrams, and changes from one to the other again and again.
inline constexpr const char* kCircles[] = {
    "b = V;",
    "if (V > b) b = V;",
    "if (V != old) { old = V; n = n + 1; }",
    "b = V & 3; a = r2;",
    "if ((V & 1) && !old) n = n + 1; old = V & 1;",
    "if ((V & 2) && !old) n = n + 1; old = V & 2;",
    "if (!(V & 1) && old) { n = n + 1; b = V; } old = V & 1;",
    "if ((V & 1) != old) { old = V & 1; if (old) n = n + 1; }",
    "t1 = V;",
    "b = b + (V - b) / 2;",
    "while (V == old); old = V; n = n + 1;",
    "",
};

// B and C stand for what is done in it.
inline constexpr const char* kLoops[] = {
    "while (1) { B }",
    "while (1) { B }",
    "while (1) { B C }",
    "for (;;) { B _Wait(K); }",
    "while (1) { B _Wait(1); }",
    "while (1) { B C _Wait(K * 3); }",
    "_Wait(K * 5); while (1) { B }",
    "while (1) { B for (m = 0; m < L; m++); }",
    "while (1) { while (H488 > 0) { B } H488 = K * 4; n = n + 1; }",
    "for (n = 0; n < K; n++) { B } while (1) { C }",
    "while (1) { if (H483 & 8) { B } else { C } }",
    "B C",
};

// What the first station does with the values that the others get: they move, or stand after a while.
inline constexpr const char* kMoving[] = {
    "while (1) { t1 = t1 + 1; _Wait(K); }",  "while (1) { t1 = t1 + L; t2 = t1 & 15; }",
    "while (1) { t1 = H511; t2 = H483; }",   "while (1) { t1 = (t1 + 1) % 9; _Wait(K * L); }",
    "while (1) { _Wait(K * 9); t2 = !t2; }",
};
inline constexpr const char* kStanding[] = {
    "t1 = K; while (1);",
    "t2 = L; t1 = L * 700;",
    "_Wait(K * 40); t1 = L; while (1) _Wait(K);",
    "while (1) t1 = H492;",
    "",
};
// Moving in a rhythm that is not that of the telegrams.
inline constexpr const char* kRhythms[] = {
    "while (1) { t1 = t1 + 1; t2 = t1 / L; _Wait(L); }",
    "while (1) { t1 = t1 + 1; _Wait(K); }",
    "while (1) { t1 = t1 + 1; t2 = t1 & L; }",
    "while (1) { t1 = (t1 + 1) % 9; t2 = !t2; _Wait(L); }",
};

}  // namespace ipos::tests
