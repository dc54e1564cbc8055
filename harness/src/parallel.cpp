#include "routebench/harness/parallel.hpp"

#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "kept_memory.hpp"

namespace routebench {
namespace {

/// Threads that sleep until there is work.
class Workers {
 public:
  Workers() = default;
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  ~Workers() {
    {
      const std::scoped_lock lock(mutex_);
      is_over_ = true;
    }
    wake_.notify_all();
  }

  /// Runs `work` in this thread and at the same time in up to so many others, and returns when all
  /// that take part are through. In this thread alone if the others are at work already, as for a
  /// loop within a loop. `work` must not throw.
  void run(std::size_t others, const std::function<void()>& work) {
    const std::unique_lock use(in_use_, std::try_to_lock);
    if (!use || !is_owner()) return work();
    begin(others);
    let_none_wake_here();
    std::unique_lock lock(mutex_);
    work_ = &work;
    places_ = others;
    lock.unlock();
    wake_.notify_all();
    work();
    lock.lock();
    places_ = 0;  // who has not come by now is too late
    done_.wait(lock, [this] { return at_work_ == 0; });
  }

  /// Whether the process is the one that has the threads, not a fork of it.
  [[nodiscard]] bool is_owner() const { return ::getpid() == owner_; }

 private:
  /// Begins threads until there are so many, or as many as the system lets the process have.
  void begin(std::size_t threads) {
    try {
      while (threads_.size() < threads) threads_.emplace_back([this] { wait_for_work(); });
    } catch (const std::system_error&) {
      // Who has begun takes part, and this thread does the rest.
    }
  }

  void wait_for_work() {
    prepare_heap_of_thread();
    std::unique_lock lock(mutex_);
    while (true) {
      wake_.wait(lock, [this] { return is_over_ || places_ > 0; });
      if (is_over_) return;
      --places_;
      ++at_work_;
      const std::function<void()>& work = *work_;
      lock.unlock();
      run_anywhere();
      work();
      lock.lock();
      if (--at_work_ == 0) done_.notify_one();
    }
  }

  /// Has the threads wake on other processors than that of this one, if there are any. A virtual
  /// machine may take a processor that sleeps for a busy one; then a thread that begins or wakes
  /// here would wait here for milliseconds.
  void let_none_wake_here() {
    const int here = ::sched_getcpu();
    if (here < 0 || CPU_COUNT(&processors_) < 2) return;
    cpu_set_t others = processors_;
    CPU_CLR(static_cast<std::size_t>(here), &others);
    for (std::jthread& thread : threads_)
      ::pthread_setaffinity_np(thread.native_handle(), sizeof others, &others);
  }

  /// Once awake a thread, and what it starts, may go where it likes.
  void run_anywhere() const {
    if (CPU_COUNT(&processors_) >= 2) ::sched_setaffinity(0, sizeof processors_, &processors_);
  }

  /// Those that the process may use; none if they cannot be told.
  static cpu_set_t usable_processors() {
    cpu_set_t processors;
    if (::sched_getaffinity(0, sizeof processors, &processors) != 0) CPU_ZERO(&processors);
    return processors;
  }

  const pid_t owner_ = ::getpid();
  const cpu_set_t processors_ = usable_processors();
  std::mutex in_use_;
  std::mutex mutex_;  // of all below
  std::condition_variable wake_, done_;
  const std::function<void()>* work_ = nullptr;
  std::size_t places_ = 0;  // workers that may still take part
  std::size_t at_work_ = 0;
  bool is_over_ = false;
  std::vector<std::jthread> threads_;  // the first to go: they use the rest
};

}  // namespace

ParallelFor parallel_loop(int jobs) {
  const std::size_t threads =
      jobs > 0 ? static_cast<std::size_t>(jobs) : std::max(1u, std::thread::hardware_concurrency());
  if (threads == 1) return serial_for;
  // A fork of the process has no threads that could be joined, so it leaves them be.
  const std::shared_ptr<Workers> workers(new Workers, [](Workers* made) {
    if (made->is_owner()) delete made;
  });
  return [threads, workers](std::size_t count, const std::function<void(std::size_t)>& body) {
    if (count == 0) return;
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
    workers->run(std::min(threads, count) - 1, work);
    if (failure) std::rethrow_exception(failure);
  };
}

}  // namespace routebench
