// The executor on oneTBB. No other file includes it.
#include "executor.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace carom {

Executor::Executor(int threads)
    : threads_(threads > 0 ? threads : tbb::info::default_concurrency()),
      arena_(std::make_shared<tbb::task_arena>(threads_)) {}

void Executor::for_ranges(std::size_t count, std::size_t grain,
                          const std::function<void(std::size_t, std::size_t)>& body) const {
    static_cast<tbb::task_arena*>(arena_.get())->execute([&] {
        const auto run = [&](const tbb::blocked_range<std::size_t>& r) { body(r.begin(), r.end()); };
        const tbb::blocked_range<std::size_t> all(0, count, grain);
        // One part a thread goes to the same thread each time, which has its data at hand.
        if (count <= grain * static_cast<std::size_t>(threads_))
            tbb::parallel_for(all, run, tbb::static_partitioner());
        else
            tbb::parallel_for(all, run, tbb::simple_partitioner());
    });
}

}  // namespace carom
