// How many threads, runs at a time and repetitions the command line, suites and kept invocations take.
#pragma once

namespace fusebench::run {

inline constexpr int kMostThreads = 1024;  ///< of a run
inline constexpr int kMostAtOnce = 1024;   ///< runs
inline constexpr int kMostRepetitions = 1000;

}  // namespace fusebench::run
