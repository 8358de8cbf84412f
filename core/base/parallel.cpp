#include "core/base/parallel.hpp"

#if defined(__SANITIZE_THREAD__)
#include <atomic>
#include <exception>
#include <thread>
#else
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#endif

#include "core/base/error.hpp"

namespace fusebench {
inline namespace base {

/// Debian's oneTBB is built without the thread sanitizer, so the sanitizer misses its synchronisation and
/// reports false races. In that build plain threads run the chunks.
struct Workers::Arena {
  explicit Arena(int threads);
  void for_each(std::size_t count, const std::function<void(std::size_t)>& body);

#if defined(__SANITIZE_THREAD__)
  std::size_t thread_count;
#else
  /// Raises the thread limit of the library, which otherwise prints a warning and uses at most one thread for
  /// each core.
  tbb::global_control limit;
  tbb::task_arena arena;
#endif
};

#if defined(__SANITIZE_THREAD__)

Workers::Arena::Arena(int threads) : thread_count(static_cast<std::size_t>(threads)) {}

void Workers::Arena::for_each(std::size_t count, const std::function<void(std::size_t)>& body) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> thrown(thread_count);
  const auto take_all = [&](std::size_t thread) {
    try {
      for (std::size_t i = next++; i < count; i = next++) body(i);
    } catch (...) {
      thrown[thread] = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t thread = 0; thread < thread_count; ++thread) threads.emplace_back(take_all, thread);
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& exception : thrown) {
    if (exception) std::rethrow_exception(exception);
  }
}

#else

Workers::Arena::Arena(int threads)
    : limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
      arena(threads) {}

void Workers::Arena::for_each(std::size_t count, const std::function<void(std::size_t)>& body) {
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, body); });
}

#endif

Workers::Workers(int threads) : threads_(threads) {
  check(threads >= 1, "at least one thread");
  if (threads > 1) arena_ = std::make_unique<Arena>(threads);
}

Workers::~Workers() = default;

void Workers::for_chunks(std::size_t count, std::size_t chunk_size,
                         const std::function<void(std::size_t, std::size_t)>& body) const {
  check(chunk_size >= 1, "chunks have at least one element");
  const std::size_t chunks = (count + chunk_size - 1) / chunk_size;
  const auto run_chunk = [&](std::size_t chunk) {
    body(chunk * chunk_size, std::min(count, (chunk + 1) * chunk_size));
  };
  if (!arena_ || chunks <= 1) {
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) run_chunk(chunk);
    return;
  }
  arena_->for_each(chunks, run_chunk);
}

}  // namespace base
}  // namespace fusebench
