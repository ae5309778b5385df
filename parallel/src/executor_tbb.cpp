// The executor on oneTBB. No other file includes it.
#include "executor.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace carom {

struct Executor::Arena {
    int threads;
    tbb::task_arena arena;
};

Executor::Executor(int threads) {
    const int count = threads > 0 ? threads : tbb::info::default_concurrency();
    arena_ = std::make_unique<Arena>(count, tbb::task_arena(count));
}
Executor::~Executor() = default;
Executor::Executor(Executor&&) noexcept = default;
Executor& Executor::operator=(Executor&&) noexcept = default;

int Executor::threads() const {
    return arena_->threads;
}

void Executor::for_ranges(std::size_t count, std::size_t grain,
                          const std::function<void(std::size_t, std::size_t)>& body) const {
    arena_->arena.execute([&] {
        const auto run = [&](const tbb::blocked_range<std::size_t>& r) { body(r.begin(), r.end()); };
        const tbb::blocked_range<std::size_t> all(0, count, grain);
        // One part a thread goes to the same thread each time, which has its data at hand.
        if (count <= grain * static_cast<std::size_t>(arena_->threads))
            tbb::parallel_for(all, run, tbb::static_partitioner());
        else
            tbb::parallel_for(all, run, tbb::simple_partitioner());
    });
}

}  // namespace carom
