#include "routebench/harness/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace routebench {

ParallelFor parallel_loop(int jobs) {
  const std::size_t threads =
      jobs > 0 ? static_cast<std::size_t>(jobs) : std::max(1u, std::thread::hardware_concurrency());
  if (threads == 1) return serial_for;
  return [threads](std::size_t count, const std::function<void(std::size_t)>& body) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::size_t failed_item = count;
    std::mutex failure_mutex;
    const auto work = [&] {
      for (std::size_t i = next++; i < count; i = next++) {
        try {
          body(i);
        } catch (...) {
          // Of several failures the lowest item's is reported, so that messages do not depend on
          // timing: items are handed out in order, hence every item below a failed one has been
          // begun and will be finished.
          const std::scoped_lock lock(failure_mutex);
          if (i < failed_item) {
            failed_item = i;
            failure = std::current_exception();
          }
          next = count;
        }
      }
    };
    {
      std::vector<std::jthread> pool;
      for (std::size_t t = 1; t < std::min(threads, count); ++t) pool.emplace_back(work);
      work();
    }
    if (failure) std::rethrow_exception(failure);
  };
}

}  // namespace routebench
