#include "routebench/harness/parallel.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace routebench {
namespace {

/// Threads that sleep until there is work. They are kept, because a new thread may be left waiting
/// on the processor of the one that made it, for milliseconds, while others are idle.
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
    std::unique_lock lock(mutex_);
    while (threads_.size() < others) threads_.emplace_back([this] { wait_for_work(); });
    // A thread that sleeps is woken where there is nothing to do, but a new one has to begin first.
    done_.wait(lock, [this] { return begun_ == threads_.size(); });
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
  void wait_for_work() {
    std::unique_lock lock(mutex_);
    ++begun_;
    done_.notify_one();
    while (true) {
      wake_.wait(lock, [this] { return is_over_ || places_ > 0; });
      if (is_over_) return;
      --places_;
      ++at_work_;
      const std::function<void()>& work = *work_;
      lock.unlock();
      work();
      lock.lock();
      if (--at_work_ == 0) done_.notify_one();
    }
  }

  const pid_t owner_ = ::getpid();
  std::mutex in_use_;
  std::mutex mutex_;  // of all below
  std::condition_variable wake_, done_;
  const std::function<void()>* work_ = nullptr;
  std::size_t begun_ = 0;   // threads
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
