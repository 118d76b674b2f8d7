// SPDX-License-Identifier: Apache-2.0
// Rendering to a noise: what is said of the error holds, and to stop at it brings none.
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <set>

#include "integrator/render/executor.h"
#include "integrator/render/render_to_noise.h"
#include "tests/integrator/film_camera.h"
#include "tests/support/statistics.h"

namespace petzval::integrator {
namespace {

using test::FilmCamera;

/// A scene by the noise of its samples. Left: light between 0.5 and 1.5. Right: dark, and one
/// sample in fifty meets a lamp of 20.
struct NoisyTracer {
    static constexpr float kChance = 0.02f, kLamp = 20;

    [[nodiscard]] f4 radiance(const PathStart& start, const Bands&, const Sampler& sampler,
                              FilmSample&, PathStats&) const {
        const float u = sampler.get1(Dim::Bsdf, 1);
        if (start.ray.direction.x < 0.5f) return splat(0.5f + u);
        return splat(0.1f + (u < kChance ? kLamp : 0.f));
    }
    [[nodiscard]] static double mean(bool right) {
        return right ? 0.1 + double(kChance) * double(kLamp) : 1;
    }
};

constexpr V2i kNoise_px{32, 16};
constexpr double kTarget = 0.2;

std::shared_ptr<NoiseTarget> target_of(V2i frame, double noise = kTarget) {
    auto out = std::make_shared<NoiseTarget>();
    out->noise = noise;
    out->floor_nits = 0.05;
    out->frame_px = frame;
    return out;
}

RenderJob job_of(const std::shared_ptr<NoiseTarget>& target, uint32_t seed, uint32_t most = 4096) {
    RenderJob job;
    job.seed = seed;
    job.end_sample = most;
    job.sampler = SamplerKind::Independent;
    job.filter = Filter(FilterKind::Box, 0.5f);
    job.noise = target;
    return job;
}

Film empty_film(V2i frame, Rect crop) {
    return {frame, crop, {}, {}, {.blocks = true}};
}

RenderResult render_on(Film& film, const RenderJob& job, int threads = 1) {
    ThreadExecutor executor(threads);
    RenderMonitor monitor;
    return render_to_noise(NoisyTracer(), FilmCamera(), job, film, executor, monitor);
}

Film noisy_film(V2i frame, const RenderJob& job, int threads = 1) {
    Film film = empty_film(frame, {0, 0, frame.x, frame.y});
    (void)render_on(film, job, threads);
    return film;
}

void expect_same(const Film& a, const Film& b, const Rect& where) {
    int differ = 0;
    for (int y = where.y0; y < where.y1; ++y)
        for (int x = where.x0; x < where.x1; ++x) {
            const V4f ca = a.colour(x, y), cb = b.colour(x, y);
            differ += std::memcmp(&ca, &cb, sizeof ca) != 0;
            differ += a.taken_count(x, y) != b.taken_count(x, y);
        }
    EXPECT_EQ(differ, 0);
}

TEST(NoiseCells, CoverTheFrameOnce) {
    for (const V2i& frame : {V2i(1, 1), V2i(15, 40), V2i(16, 16), V2i(53, 37), V2i(640, 31)}) {
        const auto target = target_of(frame);
        std::set<std::pair<int, int>> seen;
        size_t pixels = 0;
        for (int j = 0; j < target->cells().y; ++j)
            for (int i = 0; i < target->cells().x; ++i) {
                const Rect cell = target->cell(i, j);
                EXPECT_GE(cell.width(), std::min(16, frame.x));
                EXPECT_GE(cell.height(), std::min(16, frame.y));
                for (int y = cell.y0; y < cell.y1; ++y)
                    for (int x = cell.x0; x < cell.x1; ++x) {
                        seen.insert({x, y});
                        ++pixels;
                        EXPECT_EQ(target->whole_cells({x, y, x + 1, y + 1}), cell);
                    }
            }
        EXPECT_EQ(pixels, size_t(frame.x) * size_t(frame.y));
        EXPECT_EQ(seen.size(), pixels);
    }
    EXPECT_EQ(target_of({64, 32})->whole_cells({3, 4, 40, 16}), (Rect{0, 0, 48, 16}));
}

// Of 4,000 pixels whose samples are independent and have the variance 1/12: the difference of a
// half and all has the variance of all, and that of a quarter and a half twice as much.
TEST(FilmBlocks, DifferencesTellTheVariance) {
    constexpr int kPixels = 4000;
    for (const uint32_t n : {16u, 24u, 64u}) {
        const uint32_t power = std::bit_floor(n);
        Film film = empty_film({kPixels, 1}, {0, 0, kPixels, 1});
        test::Moments late, early;
        for (int x = 0; x < kPixels; ++x) {
            const Sampler sampler(SamplerKind::Independent, 7, {x, int(n), 0});
            for (uint32_t i = 0; i < n; ++i) {
                if (std::has_single_bit(i)) film.close_block(x, 0);
                FilmSample sample;
                sample.colour = Rgb(sampler.get1(Dim::Bsdf, i));
                film.add(x, 0, i, sample);
            }
            const auto [means, all, largest] = film.parts(x, 0);
            EXPECT_GT(largest, 0.5f);
            late.add(sqr(double(means[0].y) - double(means[1].y)));
            early.add(sqr(double(means[1].y) - double(means[2].y)));
        }
        EXPECT_TRUE(agrees(test::Mean(late), 1. / 12 / power)) << test::Mean(late) << n;
        EXPECT_TRUE(agrees(test::Mean(early), 2. / 12 / power)) << test::Mean(early) << n;
    }
}

TEST(SetNoise, FallsAsItsDifferencesDo) {
    // Independent samples: in proportion.
    SetNoise set{.taken = 16, .early = 0.02, .late = 0.01, .paths = 100, .pixels = 1000};
    EXPECT_NEAR(set.variance(16), 0.01, 1e-12);
    EXPECT_NEAR(set.variance(24), 0.01 / 1.5, 1e-12);
    EXPECT_NEAR(set.variance(64), 0.01 / 4, 1e-12);
    // Well spread ones fall faster, and all are better than the difference of half of them says.
    set.early = 0.04;
    EXPECT_LT(set.variance(16), 0.006);
    EXPECT_LT(set.variance(32), set.variance(16) / 2.5);
}

// Pixels that their own samples could stop would prefer what makes them look finished.
TEST(NoiseDecisions, HangOnTheOtherSetAlone) {
    const auto target = target_of({16, 16});
    const auto cell_with = [&](float of_set_0) {
        Film film = empty_film({16, 16}, {0, 0, 16, 16});
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)
                for (uint32_t i = 0; i < 16; ++i) {
                    if (std::has_single_bit(i)) film.close_block(x, y);
                    const float u = Sampler(SamplerKind::Independent, 3, {x, y, i}).get1(Dim::Bsdf);
                    FilmSample sample;
                    sample.colour = Rgb(1 + (set_of(x, y) == 0 ? of_set_0 : 0.4f) * (u - 0.5f));
                    film.add(x, y, i, sample);
                }
        return cell_noise(film, {0, 0, 16, 16}, target->floor_nits);
    };
    const CellNoise calm = cell_with(0.1f), wild = cell_with(8);
    for (const CellNoise& cell : {calm, wild}) EXPECT_EQ(cell.next_count(0, *target, 0), 16u);
    EXPECT_EQ(calm.next_count(1, *target, 0), 16u);
    EXPECT_GT(wild.next_count(1, *target, 0), 16u);
    EXPECT_EQ(calm.next_count(0, *target, 19), 20u) << "a lamp needs 19";
}

// A lamp that lights a single pixel is seen by one set only, and the other one decides.
TEST(NoiseDecisions, ASetThatWasNotStoppedByTheOtherSaysSo) {
    const auto target = target_of({16, 16}, 0.1);
    Film film = empty_film({16, 16}, {0, 0, 16, 16});
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            for (uint32_t i = 0; i < 16; ++i) {
                if (std::has_single_bit(i)) film.close_block(x, y);
                FilmSample sample;
                sample.colour = Rgb(1.f + (x == 2 && y == 4 && i == 5 ? 400.f : 0.f));
                film.add(x, y, i, sample);
            }
    const CellNoise cell = cell_noise(film, {0, 0, 16, 16}, target->floor_nits);
    EXPECT_EQ(cell.next_count(0, *target, 0), 16u);
    EXPECT_GT(cell.next_count(1, *target, 0), 16u) << "by what the first one says";
    EXPECT_NEAR(cell.sets[0].paths, 1, 0.2);
    EXPECT_TRUE(cell.is_at_least(*target, true));
    EXPECT_FALSE(cell.is_at_least(*target_of({16, 16}, 5), true));
}

// The step that comes next hangs on what is there alone: so it does not matter who was asked last.
TEST(NoiseDecisions, FinishStepsThatWereCutShort) {
    const auto target = target_of({16, 16});
    CellNoise cell;
    for (SetNoise& set : cell.sets)
        set = {
            .taken = 32, .begun = 32, .early = 2, .late = 1, .last = 0, .paths = 99, .pixels = 99};
    EXPECT_EQ(cell.next_step(*target, 0, 4096).set, 0);
    EXPECT_EQ(cell.next_step(*target, 0, 4096).end, 64u);
    cell.sets[0].taken = cell.sets[0].begun = 64;
    EXPECT_EQ(cell.next_step(*target, 0, 4096).set, 1) << "it has fewer samples";
    cell.sets[0] = {
        .taken = 32, .begun = 64, .early = 2, .late = 1, .last = 0, .paths = 99, .pixels = 99};
    EXPECT_EQ(cell.next_step(*target, 0, 4096).set, 0);
    EXPECT_EQ(cell.next_step(*target, 0, 4096).end, 64u) << "as it was begun";
    EXPECT_EQ(cell.next_step(*target, 0, 32).end, 64u) << "begun is begun";
}

// A box that is lit by spectra: from 4 to 8 samples its squared error falls to 0.18, and to 0.39
// from there to 16. The squares of differences have the ratio 7.8 then, as those of errors that
// fall to an eighth. What is printed is a tenth too small, not half.
TEST(NoiseReports, DoNotTrustOneStepThatFallsFast) {
    const auto target = target_of({16, 16});
    constexpr double kTrue = 0.0802, kLate = 0.0976, kEarly = 0.2732;
    CellNoise cell;
    for (SetNoise& set : cell.sets)
        set = {.taken = 16,
               .begun = 16,
               .early = sqr(kEarly),
               .late = sqr(kLate),
               .last = 0,
               .paths = 1e6,
               .pixels = 1e6};
    const NoiseReport said = noise_report({cell}, {0, 0, 1, 1}, *target, 4096);
    EXPECT_GT(said.noise, 0.8 * kTrue);
    EXPECT_LT(said.noise, kTrue);

    // Caution does not lift it above a target that was reached; later samples tell more.
    auto strict = *target;
    strict.noise = 0.05;
    EXPECT_NEAR(noise_report({cell}, {0, 0, 1, 1}, strict, 4096).noise, strict.noise, 1e-9);
    strict.noise = 0.03;
    EXPECT_EQ(noise_report({cell}, {0, 0, 1, 1}, strict, 4096).noise, said.noise);
    EXPECT_GE(said.worst_cell, said.noise);
    for (SetNoise& set : cell.sets) set.taken = set.begun = 32;
    EXPECT_LT(noise_report({cell}, {0, 0, 1, 1}, *target, 4096).noise, kTrue / 2);
}

TEST(NoiseReports, AreNotSmallerForCaution) {
    const auto target = target_of({16, 16});
    for (uint32_t taken = 16; taken < 32; taken += 2)
        for (const double ratio : {2., 3., 5., 7.8, 20.}) {
            CellNoise cell;
            for (SetNoise& set : cell.sets)
                set = {.taken = taken,
                       .begun = taken,
                       .early = ratio * 1e-4,
                       .late = 1e-4,
                       .last = taken > 16 ? 1e-4 : 0,
                       .paths = 1e6,
                       .pixels = 1e6};
            const NoiseReport said = noise_report({cell}, {0, 0, 1, 1}, *target, 4096);
            EXPECT_GE(said.noise, 0.99 * std::sqrt(cell.sets[0].variance(taken)))
                << taken << ' ' << ratio;
        }
}

// 400 pictures of both kinds of light: the mean of each cell against what it must be, and the error
// that is printed against the true one.
TEST(RenderToNoise, BringsNoBiasAndSaysItsError) {
    constexpr int kPictures = 400;
    const auto target = target_of(kNoise_px);
    std::array<test::Moments, 2> light;
    test::Moments ratio;
    size_t at_least = 0;
    for (uint32_t seed = 0; seed < kPictures; ++seed) {
        const Film film = noisy_film(kNoise_px, job_of(target, seed));
        double off = 0;
        for (size_t cell = 0; cell < 2; ++cell) {
            const double mean = NoisyTracer::mean(cell == 1);
            double sum = 0;
            for (int y = 0; y < 16; ++y)
                for (int x = 0; x < 16; ++x) {
                    const double value = double(film.colour(16 * int(cell) + x, y).y);
                    sum += value / 256;
                    off += sqr(value - mean) / (mean * mean + sqr(target->floor_nits)) / 512;
                }
            light[cell].add(sum / mean);
        }
        const NoiseReport said = noise_report(film, *target, 4096);
        at_least += said.at_least;
        EXPECT_EQ(said.left, said.at_least) << seed;
        if (said.left == 0) {
            EXPECT_LE(said.worst_cell, kTarget) << seed;
        }
        ratio.add(std::sqrt(off) / said.noise);
    }
    for (const test::Mean mean : light) {
        EXPECT_TRUE(agrees(mean, 1)) << mean;
        EXPECT_LT(std::fabs(mean.value - 1), kTarget / 10);
    }
    // Means of few samples make dark pixels count more than they should.
    EXPECT_GT(test::Mean(ratio).value, 0.8) << test::Mean(ratio);
    EXPECT_LT(test::Mean(ratio).value, 1.05) << test::Mean(ratio);
    EXPECT_LT(at_least, size_t{kPictures} / 20);
}

TEST(RenderToNoise, ReachesItsTargetInEachCell) {
    const auto target = target_of(kNoise_px);
    const Film film = noisy_film(kNoise_px, job_of(target, 3));
    const NoiseReport said = noise_report(film, *target, 4096);
    EXPECT_EQ(said.cells, 2u);
    EXPECT_EQ(said.left, 0u);
    EXPECT_LE(said.worst_cell, kTarget);
    EXPECT_GT(film.taken_count(20, 3), 4 * film.taken_count(3, 3)) << "the dark cell needs more";
    const auto [least, most] = film.taken_range();
    EXPECT_GE(least, kLeastOfCell);
    EXPECT_LT(most, 4096u);
}

TEST(RenderToNoise, SaysWhatItDidNotReach) {
    const auto strict = target_of(kNoise_px, 0.01);
    Film film = empty_film(kNoise_px, {0, 0, 32, 16});
    const RenderJob job = job_of(strict, 1, 64);
    const RenderResult result = render_on(film, job);
    EXPECT_FALSE(result.stopped);
    EXPECT_EQ(film.taken_range().most, 64u);
    const NoiseReport said = noise_report(film, *strict, 64);
    EXPECT_EQ(said.left, 2u);
    EXPECT_EQ(said.open, 0u);
    EXPECT_GT(said.worst_cell, 0.01);
}

// A lamp that is known to be there, and to be met by one path in ten thousand.
TEST(RenderToNoise, TakesTheSamplesThatItMust) {
    auto target = target_of(kNoise_px);
    target->least = {300, 0};
    const Film film = noisy_film(kNoise_px, job_of(target, 3));
    EXPECT_GE(film.taken_count(3, 3), 300u);
}

TEST(RenderToNoise, ACellDependsOnNothingButItself) {
    constexpr V2i frame(50, 35);
    const auto target = target_of(frame);
    const RenderJob job = job_of(target, 5);
    const Film whole = noisy_film(frame, job);
    expect_same(whole, noisy_film(frame, job, 3), {0, 0, 50, 35});
    const Rect crop = target->whole_cells({20, 20, 21, 21});
    Film part = empty_film(frame, crop);
    (void)render_on(part, job);
    expect_same(whole, part, crop);
    // Stopped after each cell, and packed as a state is.
    Film kept = empty_film(frame, {0, 0, 50, 35});
    int runs = 0;
    for (bool stopped = true; stopped; ++runs) {
        Film next = empty_film(frame, {0, 0, 50, 35});
        std::vector<uint8_t> pixel(Film::bytes_per_pixel(0, {}, {.blocks = true}));
        for (int y = 0; y < 35; ++y)
            for (int x = 0; x < 50; ++x) {
                kept.pack(x, y, pixel.data());
                next.add_packed(x, y, pixel.data());
            }
        ThreadExecutor executor(1);
        RenderMonitor monitor;
        RenderJob some = job;
        some.time_limit_s = 1e9;
        some.wall_s = [&] {
            if (monitor.pixel_samples_done > 0) monitor.stop = true;
            return 0.;
        };
        stopped =
            render_to_noise(NoisyTracer(), FilmCamera(), some, next, executor, monitor).stopped;
        kept = std::move(next);
        ASSERT_LT(runs, 1000);
    }
    EXPECT_GT(runs, 10);
    expect_same(whole, kept, {0, 0, 50, 35});
}

TEST(RenderToNoise, ABlackPictureIsDone) {
    struct Black {
        [[nodiscard]] f4 radiance(const PathStart&, const Bands&, const Sampler&, FilmSample&,
                                  PathStats&) const {
            return f4{};
        }
    };
    const auto target = target_of(kNoise_px);
    target->floor_nits = 0;
    Film film = empty_film(kNoise_px, {0, 0, 32, 16});
    ThreadExecutor executor(1);
    RenderMonitor monitor;
    (void)render_to_noise(Black(), FilmCamera(), job_of(target, 1), film, executor, monitor);
    EXPECT_EQ(film.taken_range().most, kLeastOfCell);
    EXPECT_EQ(noise_report(film, *target, 4096).left, 0u);
}

}  // namespace
}  // namespace petzval::integrator
