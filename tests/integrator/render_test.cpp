// SPDX-License-Identifier: Apache-2.0
#include "integrator/render/render.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <cstring>
#include <mutex>
#include <set>

#include "camera/models/thin_lens.h"
#include "integrator/render/executor.h"
#include "tests/support/traced_world.h"

namespace petzval::integrator {
namespace {

struct Studio : test::TracedWorld {
    std::unique_ptr<camera::Camera> camera;

    explicit Studio(V2i size) {
        using namespace test;
        place(scene, quad(V3f(-3, -3, -1), V3f(6, 0, 0), V3f(0, 6, 0)), diffuse_material(0.6f));
        Material metal;
        metal.roughness = 0.3f;
        place(scene, sphere(V3f(0, 0, 0), 0.6f, 24, true), metal);
        place(scene, quad(V3f(-1, 1.5f, 1), V3f(2, 0, 0), V3f(0, 1, 0.5f)), emitter_material(5.f));
        scene.sky = Sky::uniform(Rgb(0.1f, 0.2f, 0.4f));
        finish();
        camera::ThinLens lens;
        lens.to_world = camera::look_at(V3f(0.5f, 0.7f, 4), V3f(0.f));
        lens.aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
        lens.iris = camera::Iris(camera::Disk{}, 50);
        lens.focus_m = 3.5f;
        camera = std::make_unique<camera::ThinLensCamera>(lens);
    }
};

const V2i kRender_px(53, 37);
const Rect kAllPixels{0, 0, kRender_px.x, kRender_px.y};

template <class Executor>
Film film_with(Executor executor, RenderJob job, Rect crop = kAllPixels,
               RenderResult* result = nullptr) {
    static const Studio studio(kRender_px);
    Film film(kRender_px, crop, {Aov::Albedo, Aov::Normal, Aov::Depth});
    RenderMonitor monitor;
    const RenderResult r = render(*studio.tracer, *studio.camera, job, film, executor, monitor);
    if (result) *result = r;
    return film;
}

RenderJob job_with(uint32_t spp) {
    RenderJob job;
    job.end_sample = spp;
    return job;
}

void expect_same_bytes(const Film& a, const Film& b, Rect where = kAllPixels) {
    int differ = 0;
    for (int y = where.y0; y < where.y1; ++y)
        for (int x = where.x0; x < where.x1; ++x) {
            const V4f ca = a.colour(x, y), cb = b.colour(x, y);
            differ += std::memcmp(&ca, &cb, sizeof ca) != 0;
            for (size_t layer = 0; layer < a.aovs().size(); ++layer) {
                const V3f va = a.aov(x, y, layer), vb = b.aov(x, y, layer);
                differ += std::memcmp(&va, &vb, sizeof va) != 0;
            }
        }
    EXPECT_EQ(differ, 0);
}

TEST(Tiles, CoverEveryPixelOnce) {
    for (const Rect crop : {Rect{0, 0, 53, 37}, Rect{5, 7, 6, 8}, Rect{3, 1, 100, 17}})
        for (const int size : {1, 8, 16}) {
            std::set<std::pair<int, int>> seen;
            size_t pixels = 0;
            for (const Rect& t : tiles_of(crop, size))
                for (int y = t.y0; y < t.y1; ++y)
                    for (int x = t.x0; x < t.x1; ++x) {
                        seen.insert({x, y});
                        ++pixels;
                        EXPECT_TRUE(x >= crop.x0 && x < crop.x1 && y >= crop.y0 && y < crop.y1);
                    }
            EXPECT_EQ(pixels, static_cast<size_t>(crop.width() * crop.height()));
            EXPECT_EQ(seen.size(), pixels);
        }
}

TEST(Tiles, NeighboursInTimeTouch) {
    const auto tiles = tiles_of({0, 0, 128, 128}, 16);
    for (size_t i = 1; i < tiles.size(); ++i)
        EXPECT_EQ(std::abs(tiles[i].x0 - tiles[i - 1].x0) + std::abs(tiles[i].y0 - tiles[i - 1].y0),
                  16);
}

TEST(Render, PixelsDoNotDependOnThreads) {
    const Film one = film_with(ThreadExecutor(1), job_with(8));
    expect_same_bytes(one, film_with(ThreadExecutor(2), job_with(8)));
    expect_same_bytes(one, film_with(ThreadExecutor(5), job_with(8)));
}

TEST(RenderTbb, PixelsDoNotDependOnThreads) {
    const Film one = film_with(ThreadExecutor(1), job_with(8));
    for (const int threads : {1, 2, 5}) {
        TbbExecutor executor(threads);
        static const Studio studio(kRender_px);
        Film film(kRender_px, kAllPixels, {Aov::Albedo, Aov::Normal, Aov::Depth});
        RenderMonitor monitor;
        (void)render(*studio.tracer, *studio.camera, job_with(8), film, executor, monitor);
        expect_same_bytes(one, film);
    }
}

TEST(Render, PixelsDoNotDependOnTileSize) {
    RenderJob small = job_with(8);
    small.tile_size_px = 8;
    expect_same_bytes(film_with(ThreadExecutor(2), job_with(8)),
                      film_with(ThreadExecutor(2), small));
}

TEST(Render, ACropIsAPartOfTheWhole) {
    const Rect crop{11, 6, 30, 29};
    expect_same_bytes(film_with(ThreadExecutor(2), job_with(8)),
                      film_with(ThreadExecutor(2), job_with(8), crop), crop);
}

// The first 16 samples of 64 are the 16 samples of 16: stopped there, both films are the same.
TEST(Render, AShorterRenderIsAPrefixOfALongerOne) {
    const Film whole = film_with(ThreadExecutor(2), job_with(64));
    const Film first = film_with(ThreadExecutor(2), job_with(16));
    RenderJob rest = job_with(64);
    rest.first_sample = 16;
    const Film last = film_with(ThreadExecutor(2), rest);
    for (int y = 0; y < kRender_px.y; ++y)
        for (int x = 0; x < kRender_px.x; ++x)
            for (int i = 0; i < 4; ++i)
                EXPECT_NEAR(whole.colour(x, y)[i],
                            (first.colour(x, y)[i] + 3 * last.colour(x, y)[i]) / 4,
                            4e-7 * (1 + whole.colour(x, y)[i]));
}

// Holds every thread back until all have come: with more threads
// than cores, a fast one would otherwise do all the work before the last wakes up.
class CountingTracer {
  public:
    explicit CountingTracer(int threads) : threads_(threads) {}

    f4 radiance(const PathStart&, const Bands&, const Sampler&, FilmSample&, PathStats&) const {
        std::unique_lock lock(mutex_);
        if (arrived_.insert(std::this_thread::get_id()).second) {
            all_.notify_all();
            // Minutes, as a machine may be busy: only a thread that never comes takes them.
            all_.wait_for(lock, std::chrono::minutes(5),
                          [&] { return static_cast<int>(arrived_.size()) >= threads_; });
        }
        return splat(1.f);
    }
    [[nodiscard]] int arrived() const { return static_cast<int>(arrived_.size()); }

  private:
    int threads_;
    mutable std::mutex mutex_;
    mutable std::condition_variable all_;
    mutable std::set<std::thread::id> arrived_;
};

template <class Executor>
void expect_all_threads_work(int threads) {
    const CountingTracer tracer(threads);
    const camera::ThinLensCamera camera((camera::ThinLens()));
    Film film(kRender_px, kAllPixels, {});
    RenderMonitor monitor;
    Executor executor(threads);
    const RenderResult result = render(tracer, camera, job_with(5), film, executor, monitor);
    EXPECT_EQ(result.workers, threads);
    EXPECT_GE(tracer.arrived(), threads);  // threads of a later pass may have other names
    EXPECT_EQ(result.end_sample, 5u);
    EXPECT_EQ(result.stats.samples, 5u * kRender_px.x * kRender_px.y);
    EXPECT_EQ(monitor.pixel_samples_done, result.stats.samples);
    for (int y = 0; y < kRender_px.y; ++y)
        for (int x = 0; x < kRender_px.x; ++x) {
            EXPECT_EQ(film.sample_count(x, y), 5u);
            EXPECT_EQ(film.colour(x, y)[0], 1.f);
        }
}

TEST(Render, EveryPixelIsSampledExactlySppTimesByAllThreads) {
    for (const int threads : {1, 2, 5}) expect_all_threads_work<ThreadExecutor>(threads);
}

TEST(RenderTbb, EveryPixelIsSampledExactlySppTimesByAllThreads) {
    for (const int threads : {1, 2, 5}) expect_all_threads_work<TbbExecutor>(threads);
}

TEST(Render, StopsWhenTold) {
    static const Studio studio(kRender_px);
    Film film(kRender_px, kAllPixels, {});
    RenderMonitor monitor;
    monitor.stop = true;
    ThreadExecutor executor(2);
    const RenderResult result =
        render(*studio.tracer, *studio.camera, job_with(8), film, executor, monitor);
    EXPECT_TRUE(result.stopped);
    EXPECT_EQ(result.end_sample, 0u);
}

// An executor that asks for a pause, or for a stop, whenever so many samples more are done.
class InterruptingExecutor {
  public:
    InterruptingExecutor(const RenderMonitor& monitor, std::atomic<bool>& flag, uint64_t samples)
        : monitor_(monitor), flag_(flag), due_(samples), samples_(samples) {}
    [[nodiscard]] static int threads() { return 2; }
    template <class F>
    void run(int count, const F& f) {
        ThreadExecutor(2).run(count, [&](int task, int worker) {
            f(task, worker);
            if (monitor_.pixel_samples_done < due_) return;
            due_ += samples_;
            flag_ = true;
        });
    }

  private:
    const RenderMonitor& monitor_;
    std::atomic<bool>& flag_;
    std::atomic<uint64_t> due_;
    uint64_t samples_;
};

TEST(Render, PausesChangeNothing) {
    static const Studio studio(kRender_px);
    const Film whole = film_with(ThreadExecutor(2), job_with(24));
    for (const uint64_t samples : {1, 300, 1000, 1961, 5000}) {
        Film film(kRender_px, kAllPixels, {Aov::Albedo, Aov::Normal, Aov::Depth});
        RenderMonitor monitor;
        RenderJob job = job_with(24);
        int pauses = 0;
        job.at_pause = [&](const PathStats&) { ++pauses; };
        InterruptingExecutor executor(monitor, monitor.pause, samples);
        const RenderResult result =
            render(*studio.tracer, *studio.camera, job, film, executor, monitor);
        EXPECT_FALSE(result.stopped);
        EXPECT_GT(pauses, 2) << samples;
        EXPECT_EQ(result.stats.samples, uint64_t(kRender_px.x) * kRender_px.y * 24);
        expect_same_bytes(whole, film);
    }
}

// Stopped again and again in the middle of a pass, with tiles that are ahead of others.
TEST(Render, GoesOnWhereItWasStopped) {
    static const Studio studio(kRender_px);
    const Film whole = film_with(ThreadExecutor(2), job_with(24));
    for (const uint64_t interval : {300, 1961, 5000}) {
        Film film(kRender_px, kAllPixels, {Aov::Albedo, Aov::Normal, Aov::Depth});
        uint64_t samples = 0;
        int runs = 0;
        RenderResult result;
        for (result.stopped = true; result.stopped; ++runs) {
            RenderMonitor monitor;
            InterruptingExecutor executor(monitor, monitor.stop, interval);
            result = render(*studio.tracer, *studio.camera, job_with(24), film, executor, monitor);
            samples += result.stats.samples;
        }
        EXPECT_GT(runs, 3) << interval;
        EXPECT_EQ(samples, uint64_t(kRender_px.x) * kRender_px.y * 24);
        expect_same_bytes(whole, film);
    }
}

// Ranges of samples, each in a film of its own, add up to the film of all.
TEST(Render, RangesAddUpToTheWhole) {
    static const Studio studio(kRender_px);
    const Film whole = film_with(ThreadExecutor(2), job_with(24));
    Film sum(kRender_px, kAllPixels, {Aov::Albedo, Aov::Normal, Aov::Depth});
    std::vector<uint8_t> packed(Film::bytes_per_pixel(3, {}));
    for (const SampleRange range : {SampleRange{7, 20}, SampleRange{0, 7}, SampleRange{20, 24}}) {
        RenderJob job = job_with(range.end);
        job.first_sample = range.first;
        const Film part = film_with(ThreadExecutor(2), job);
        for (int y = 0; y < kRender_px.y; ++y)
            for (int x = 0; x < kRender_px.x; ++x) {
                part.pack(x, y, packed.data());
                sum.add_packed(x, y, packed.data());
            }
    }
    expect_same_bytes(whole, sum);
}

// As any number of samples is rendered by a machine that takes a second for one of every pixel, or
// another time that it is given: the samples at which a time limit ends it.
uint32_t samples_within(double limit_s, uint32_t spp, double (*time_of_s)(double samples)) {
    static const Studio studio(kRender_px);
    Film film(kRender_px, kAllPixels, {});
    RenderMonitor monitor;
    RenderJob job = job_with(spp);
    job.time_limit_s = limit_s;
    job.wall_s = [&] {
        const double samples = double(monitor.pixel_samples_done) / (kRender_px.x * kRender_px.y);
        return 1e6 + time_of_s(samples);  // a clock starts anywhere
    };
    ThreadExecutor executor(2);
    const RenderResult result =
        render(*studio.tracer, *studio.camera, job, film, executor, monitor);
    EXPECT_FALSE(result.stopped);
    for (int y = 0; y < kRender_px.y; ++y)
        for (int x = 0; x < kRender_px.x; ++x)
            EXPECT_EQ(film.sample_count(x, y), result.end_sample);
    return result.end_sample;
}

TEST(Render, ATimeLimitEndsAWholePass) {
    const auto even = [](double samples) { return samples; };
    EXPECT_EQ(samples_within(10, 1u << 30, even), 10u) << "passes of 1, 1, 2, 4, and what is left";
    EXPECT_EQ(samples_within(10.9, 1u << 30, even), 10u) << "a sample that does not fit is left";
    EXPECT_EQ(samples_within(40, 1u << 30, even), 40u) << "passes of 16 at most";
    EXPECT_EQ(samples_within(0.1, 1u << 30, even), 1u) << "the first is rendered in any case";
    EXPECT_EQ(samples_within(1e9, 7, even), 7u) << "the samples are there before the time is over";
    // It slows down: 1, 2, 4, 8, 12 samples are there after 1, 4, 16, 64, 144 seconds.
    const auto slowing = [](double samples) { return samples * samples; };
    EXPECT_EQ(samples_within(100, 1u << 30, slowing), 12u) << "36 s left, 8 s for each so far: 4";
    const auto at_once = [](double) { return 0.; };
    EXPECT_EQ(samples_within(1, 40, at_once), 40u) << "a clock that stands still";
}

// Pauses in the middle of a pass, by a clock that runs faster and faster: a pass that was begun is
// finished in every pixel, whatever the time is then.
TEST(Render, ATimeLimitWithPausesEndsEvenly) {
    static const Studio studio(kRender_px);
    for (const double limit_s : {60., 200., 900.}) {
        Film film(kRender_px, kAllPixels, {});
        RenderMonitor monitor;
        RenderJob job = job_with(1u << 30);
        job.time_limit_s = limit_s;
        job.wall_s = [&] {
            const double samples =
                double(monitor.pixel_samples_done) / (kRender_px.x * kRender_px.y);
            return samples * samples;
        };
        InterruptingExecutor executor(monitor, monitor.pause, 700);
        const RenderResult result =
            render(*studio.tracer, *studio.camera, job, film, executor, monitor);
        EXPECT_GE(result.end_sample, 7u);
        EXPECT_EQ(film.taken_range().most, result.end_sample) << limit_s;
        EXPECT_EQ(film.taken_range().least, result.end_sample) << limit_s;
    }
}

// Not a number for one half of the picture.
class BadTracer {
  public:
    f4 radiance(const PathStart& start, const Bands&, const Sampler&, FilmSample&,
                PathStats&) const {
        return splat(start.ray.direction.x > 0 ? std::numeric_limits<float>::quiet_NaN() : 2.f);
    }
};

TEST(Render, SamplesThatAreNotFiniteAreCountedAndLeftOut) {
    const camera::ThinLensCamera camera((camera::ThinLens()));
    Film film(kRender_px, kAllPixels, {});
    RenderMonitor monitor;
    ThreadExecutor executor(2);
    (void)render(BadTracer(), camera, job_with(4), film, executor, monitor);
    EXPECT_GT(film.left_out().not_finite, 0u);
    EXPECT_EQ(film.left_out().y, 0);
    for (int y = 0; y < kRender_px.y; ++y)
        for (int x = 0; x < kRender_px.x; ++x) EXPECT_TRUE(std::isfinite(film.colour(x, y)[0]));
    EXPECT_EQ(film.colour(3, 3)[0], 2.f);
}

}  // namespace
}  // namespace petzval::integrator
