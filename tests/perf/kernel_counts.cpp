#include "tests/perf/kernel_counts.hpp"

#include <valgrind/callgrind.h>

namespace fusebench::perf {

void KernelCounts::count(std::string_view name, std::string_view item, const std::function<void()>& kernel,
                         const std::function<std::size_t()>& items_if_right) {
  CountedKernel counted{std::string(name), 0, std::string(item)};
  const auto work = [&] {  // throws unless it is right
    const std::size_t items = items_if_right();
    check(items > 0, "the kernel has something to work on");
    return items;
  };
  kernel();
  work();

  // Nothing else is instrumented: the scene would take most of the time. Without zeroing, a dump's summary is
  // less what the dump before it had.
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_ZERO_STATS;
  kernel();
  CALLGRIND_DUMP_STATS_AT(counted.name.c_str());
  CALLGRIND_STOP_INSTRUMENTATION;
  counted.items = work();
  counted_.push_back(std::move(counted));
}

}  // namespace fusebench::perf
