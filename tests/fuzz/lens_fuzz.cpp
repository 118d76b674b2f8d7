// SPDX-License-Identifier: Apache-2.0
// Random lenses by the million through all that is done with a lens: nothing may crash, hang, throw
// anything but std::invalid_argument, or make a number that is none of what was one. Half of them
// are meant to break something; a tenth has numbers of any size, which may come to nothing but not
// crash. For a build with sanitizers:
//
//   cmake --preset asan && cmake --build build-asan --target lens_fuzz
//   build-asan/bin/lens_fuzz [COUNT=1000000] [SEED=1] [--threads 2] [--seconds S] [--go-on]
//
// Prints the lens of the first fault and ends with 1; `lens_fuzz 1 SEED --first N` repeats lens N.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/common_interface_defs.h>
#endif

#include "camera/bench/aimed_bundle.h"
#include "camera/bench/analysis.h"
#include "camera/lens/focus.h"
#include "camera/lens/profile.h"
#include "camera/lens/traced_ray.h"
#include "camera/models/lens_camera.h"
#include "tests/support/nasty_lens.h"

namespace petzval {
namespace {

using test::between;
using test::by_chance;
using test::Random;
using Clock = std::chrono::steady_clock;

struct Fault {
    std::string what;
};
void require(bool holds, const char* what) {
    if (!holds) throw Fault{what};
}

enum class Kind { Random, Nasty, Wild };

struct Subject {
    uint32_t seed = 0;
    uint64_t number = 0;
    Kind kind = Kind::Random;
    camera::Prescription prescription;
};

Subject subject_of(uint32_t seed, uint64_t number, Random& random) {
    Subject out{seed, number, Kind::Random, {}};
    const float kind = random.next();
    if (kind < 0.5f) {
        out.prescription = test::random_prescription(random);
    } else {
        out.kind = kind < 0.9f ? Kind::Nasty : Kind::Wild;
        out.prescription = test::nasty_prescription(random, out.kind == Kind::Wild);
    }
    return out;
}

void print(const Subject& subject, const std::string& what) {
    fmt::print("FAULT: {}\nlens_fuzz 1 {} --first {}\n{}\n", what, subject.seed, subject.number,
               test::text_of(subject.prescription));
    std::fflush(stdout);
}

// What this thread is at: the sanitizers' last words are a function without arguments.
const Subject*& current() {
    static thread_local const Subject* subject = nullptr;
    return subject;
}

void print_current() {
    if (current()) print(*current(), "a sanitizer's, as above");
}

struct Tally {
    std::atomic<uint64_t> lenses{0}, refused{0}, rays{0}, passed{0}, differ{0}, cameras{0}, lit{0},
        focused{0}, slowest_ms{0}, slowest{0};
};

// Readers of lenses refuse all that is not from 1 to 5. Far beyond that Snell's law loses its
// digits, and the direction its unit length.
bool is_index(double n) {
    return n > 0.1 && n < 10;
}

// An asphere's curvature at its vertex, to the powers that the third order has.
bool overflows(const camera::Prescription& lens) {
    for (const camera::LensSurface& surface : lens.surfaces)
        for (const auto& [power, a] : surface.asphere)
            if (std::fabs(a) > 1e50) return true;
    return false;
}

/// All that is done with one lens.
class Trial {
  public:
    Trial(const Subject& subject, Random& random, Tally& tally)
        : random_(random), tally_(tally), kind_(subject.kind), lens_(subject.prescription) {
        const auto& media = lens_.media();
        sound_ = kind_ != Kind::Wild &&
                 std::all_of(media.begin(), media.end(),
                             [](const Glass& glass) {
                                 return is_index(glass.index(kLineF_nm)) &&
                                        is_index(glass.index(kLineD_nm)) &&
                                        is_index(glass.index(kLineC_nm));
                             }) &&
                 !overflows(subject.prescription);
    }

    void run() {
        trace_all();
        first_orders();
        share(0.25f, [&] { trace(); });
        share(0.125f, [&] { outlines(); });
        share(0.06f, [&] { stops(); });
        share(0.02f, [&] { bundles(); });
        share(lens_.prescription().focus_group ? 0.01f : 0.25f, [&] { focus(); });
        share(lens_.size() > 50 ? 2e-4f : 5e-3f, [&] { camera(); });
        share(2e-3f, [&] { fields(); });
    }

  private:
    void share(float chance, const std::function<void()>& part) {
        if (!by_chance(random_, chance)) return;
        try {
            part();
        } catch (const std::invalid_argument&) {
            ++tally_.refused;
        }
    }

    double wavelength_nm() {
        return by_chance(random_, 0.5f) ? kLineD_nm : between(random_, 360, 830);
    }

    void trace_all() {
        for (const auto towards : {camera::Towards::Film, camera::Towards::Scene}) {
            const camera::Clip clip =
                by_chance(random_, 0.5f) ? camera::Clip::Yes : camera::Clip::No;
            std::array<test::Line, 4> lines;
            for (auto& line : lines)
                line = test::random_line(random_, towards == camera::Towards::Film);
            const double nm = wavelength_nm();
            auto doubles = test::rays_of<d4>(lines);
            auto floats = test::rays_of<f4>(lines);
            auto dual = test::with_derivatives(floats);
            const auto indices = by_chance(random_, 0.5f) ? lens_.exact_indices(splat(float(nm)))
                                                          : lens_.indices(splat(float(nm)));
            (void)camera::trace_lens({lens_, towards, test::whole(lens_), clip},
                                     lens_.exact_indices(camera::broadcast<d4>(nm)), doubles);
            (void)camera::trace_lens({lens_, towards, test::whole(lens_), clip}, indices, floats);
            (void)camera::trace_lens({lens_, towards, test::whole(lens_), clip}, indices, dual);
            if (kind_ == Kind::Wild || !has_indices(nm, indices)) continue;
            // Light that grazed a surface comes from so far away that digits are gone.
            defined(doubles, towards, kind_ == Kind::Random ? 1e-9 : 0.01, "doubles");
            defined(floats, towards, 0.5, "floats");
            defined(dual, towards, 0.5, "Duals");
            // Derivatives may change a value's last digit, as a quotient is another product there.
            for (int i = 0; i < 4; ++i) {
                ++tally_.rays;
                tally_.passed += doubles.status(i) == camera::RayStatus::Passed;
                tally_.differ += dual.status(i) != floats.status(i);
            }
        }
    }
    // Between two nanometres the table may know of a pole what the formula does not.
    bool has_indices(double nm, const camera::LensIndices<f4>& indices) const {
        for (size_t i = 0; i < lens_.media().size(); ++i)
            if (!is_index(lens_.media()[i].index(nm)) || !is_index(indices.of_medium[i][0]))
                return false;
        return true;
    }
    template <class N>
    void defined(const camera::LensRay<N>& ray, camera::Towards towards, double tolerance,
                 const char* numbers) {
        const std::string fault = test::fault_of(ray, lens_, towards, tolerance);
        if (!fault.empty())
            throw Fault{fmt::format("trace towards the {} in {}: {}",
                                    towards == camera::Towards::Film ? "film" : "scene", numbers,
                                    fault)};
    }

    void first_orders() {
        for (const auto section : {camera::Section::X, camera::Section::Y}) {
            const camera::FirstOrder f = camera::first_order(lens_, kLineD_nm, section);
            const auto image = camera::image_of(lens_, -1000, kLineD_nm, section);
            if (!sound_) continue;
            for (const double a :
                 {f.focal_length_mm, f.back_focus_mm, f.front_focus_mm, f.entrance_pupil_mm,
                  f.exit_pupil_mm, image.from_last_vertex_mm, image.magnification})
                require(!std::isnan(a), "a first-order length is NaN");
            if (section == camera::Section::Y) entrance_pupil_mm_ = f.entrance_pupil_mm;
        }
        if (!std::isfinite(entrance_pupil_mm_)) entrance_pupil_mm_ = 0;
        try {
            const camera::Seidel sums = camera::seidel(lens_, 0.3);
            const camera::FirstOrder f = camera::first_order(lens_, kLineD_nm);
            if (sound_ && std::isfinite(f.entrance_pupil_mm) &&
                std::isfinite(f.entrance_pupil_diameter_mm))
                for (const double sum : sums.total)
                    require(!std::isnan(sum), "a Seidel sum is NaN");
        } catch (const std::invalid_argument&) {
            ++tally_.refused;
        }
    }

    void trace() {
        for (const auto towards : {camera::Towards::Film, camera::Towards::Scene}) {
            const auto line = test::random_line(random_, towards == camera::Towards::Film);
            const auto v = [](const test::Three& a) { return V3d(a[0], a[1], a[2]); };
            const double nm = wavelength_nm();
            const camera::TracedRay ray = camera::trace_ray(
                lens_, v(line.origin), v(line.direction), nm, towards, camera::Clip::Yes);
            require(ray.points.size() <= size_t(lens_.size()), "more points than surfaces");
            if (kind_ == Kind::Wild || !has_indices(nm, lens_.exact_indices(splat(float(nm)))))
                continue;
            for (const V3d& p : ray.points)
                require(std::isfinite(p.x + p.y + p.z), "a traced point is not finite");
            if (ray.status == camera::RayStatus::Passed) {
                require(ray.points.size() == size_t(lens_.size()), "a passed ray lacks a point");
                require(std::isfinite(ray.path_mm), "an optical path is not finite");
                if (const auto film = ray.at_plane(lens_.film_mm()))
                    require(!std::isnan((*film)[0] + (*film)[1]), "a film point is NaN");
            } else {
                require(ray.end_surface >= 0 && ray.end_surface < lens_.size(),
                        "a blocked ray ends on no surface");
            }
        }
    }

    void outlines() {
        for (int i = 0; i < lens_.size(); ++i)
            for (const auto& point : camera::element_outline(lens_, i, camera::Section::Y))
                require(!std::isnan(point[0] + point[1]), "an outline is NaN");
    }

    void stops() {
        const double wanted = between(random_, 0.5, 32);
        if (const auto radius = camera::stop_radius_for(lens_, wanted)) {
            require(std::isfinite(*radius) && *radius >= 0, "a stop radius is none");
            require(camera::fnumber_of(lens_, *radius) > 0, "an f-number is none");
        }
    }

    void focus() {
        const double object = by_chance(random_, 0.5f) ? -INFINITY : -between(random_, 10, 10000);
        const camera::FocusBy by =
            by_chance(random_, 0.1f) ? camera::FocusBy::Traced : camera::FocusBy::Paraxial;
        const auto sharp = camera::focused(lens_, object, by);
        tally_.focused += sharp.has_value();
        if (sharp)
            for (const auto& surface : sharp->prescription().surfaces)
                require(std::isfinite(surface.thickness_mm), "a focused thickness is not finite");
    }

    void bundles() {
        const camera::ObjectPoint object{
            between(random_, 0, 80),
            by_chance(random_, 0.5f) ? INFINITY : between(random_, 1, 10000),
            by_chance(random_, 0.5f) ? camera::Section::X : camera::Section::Y};
        const auto bundle = camera::AimedBundle::aim(lens_, object, wavelength_nm());
        if (!bundle) return;
        for (const camera::BundleRay& ray : bundle->trace(bundle->grid(5), lens_.film_mm()))
            require(!std::isnan(ray.film_mm[0] + ray.film_mm[1]), "a bundle's film point is NaN");
    }

    void fields() {
        const auto angle =
            camera::field_of_height_deg(lens_, between(random_, 0, 20), lens_.film_mm());
        require(!angle || (*angle >= 0 && *angle <= 120), "a field is out of its range");
        (void)camera::distortion(lens_, between(random_, 1, 60), lens_.film_mm(), INFINITY);
        (void)camera::stated_figures(lens_);
    }

    void camera() {
        const double film_behind_mm = lens_.prescription().surfaces.back().thickness_mm;
        const auto& stop = lens_.prescription().surfaces[size_t(lens_.stop())];
        const camera::ApertureShape shapes[] = {camera::Disk{}, camera::regular_polygon(6, 10, 0.3),
                                                camera::star(5)};
        camera::LensCameraInput in{
            .lens = std::make_shared<const camera::Lens>(lens_),
            .iris = camera::Iris(shapes[int(random_.next() * 3)],
                                 stop.semi_diameter_mm * between(random_, 0.01, 1.2)),
            .to_world = M44f()};
        in.film_mm = lens_.vertex_mm(lens_.last()) +
                     (film_behind_mm > 0 ? film_behind_mm : between(random_, 1, 100));
        in.entrance_pupil_mm = entrance_pupil_mm_;
        const camera::DispersionMode modes[] = {camera::DispersionMode::Shared,
                                                camera::DispersionMode::Split,
                                                camera::DispersionMode::Hero};
        in.dispersion = modes[int(random_.next() * 3)];
        const camera::LensCamera made(std::move(in));
        ++tally_.cameras;
        Bands bands = Bands::rgb();
        bands.spectral = true;
        bands.on = m4{-1, -1, -1, -1};
        for (int i = 0; i < 32; ++i) {
            const V2f film = random_.next2() * 40.f - V2f(20.f);
            Bands of_sample = i % 2 ? bands : Bands::rgb();
            of_sample.hero = i / 2 % lane_count(of_sample.on);
            for (int k = 0; k < 4; ++k) bands.nm[k] = float(between(random_, 360, 830));
            const V2f u = random_.next2();
            const auto drawn = made.draw(film, u, of_sample);
            require(camera::all(drawn.weight >= 0.f) && camera::all(drawn.weight < INFINITY),
                    "a bad weight");
            check(made.sample({random_.next2(), Sampler(SamplerKind::Owen, 1, {i, i, 0})},
                              of_sample));
        }
        const double irradiance = made.irradiance(V2f(0.f, float(between(random_, 0, 14))), 64);
        require(std::isfinite(irradiance) && irradiance >= 0, "an irradiance is none");
        tally_.lit += irradiance > 0;
    }
    static void check(const camera::CameraSample& sample) {
        require(sample.size() <= 4, "a bad number of rays");
        for (size_t i = 0; i < sample.size(); ++i) {
            const camera::CameraPath& path = sample[i];
            const V3f sum = path.ray.origin + path.ray.direction;
            require(std::isfinite(sum.x + sum.y + sum.z), "a camera ray is not finite");
            require(std::fabs(path.ray.direction.length() - 1) < 1e-4f, "a camera ray's length");
            require(camera::all(path.weight >= 0.f) && camera::all(path.weight < INFINITY),
                    "a bad path weight");
        }
    }

    Random& random_;
    Tally& tally_;
    Kind kind_;
    camera::Lens lens_;
    bool sound_;  ///< numbers that a file may have, and glasses with an index
    double entrance_pupil_mm_ = 0;
};

/// What is wrong with a lens; empty where all is well.
std::string fault_of(const Subject& subject, Random& random, Tally& tally) {
    try {
        Trial(subject, random, tally).run();
    } catch (const Fault& fault) {
        return fault.what;
    } catch (const std::invalid_argument&) {
        ++tally.refused;
    } catch (const std::exception& error) {
        return fmt::format("an exception of another kind: {}", error.what());
    }
    return {};
}

int run(int argc, char** argv) {
    CLI::App app("Random lenses through all that is done with a lens.");
    uint64_t count = 1000000, first = 0;
    uint32_t seed = 1;
    int threads = 2;
    double seconds = 1e9;
    bool go_on = false;
    app.add_option("count", count, "lenses")->capture_default_str();
    app.add_option("seed", seed)->capture_default_str();
    app.add_option("--threads", threads)->capture_default_str()->check(CLI::Range(1, 256));
    app.add_option("--first", first, "number of the first lens")->capture_default_str();
    app.add_option("--seconds", seconds, "begin no lens after this time");
    app.add_flag("--go-on", go_on, "after a fault, to the next lens");
    CLI11_PARSE(app, argc, argv);
#ifdef __SANITIZE_ADDRESS__
    __sanitizer_set_death_callback(print_current);
#endif
    Tally tally;
    std::atomic<uint64_t> next{first}, faults{0};
    std::mutex printing;
    // What each thread is at, for the watch: number and when it began, ms.
    struct Watched {
        std::atomic<uint64_t> number{0}, since_ms{0};
    };
    std::vector<Watched> watched(static_cast<size_t>(threads));
    const auto start = Clock::now();
    const auto now_ms = [&] {
        return uint64_t(
            std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - start).count());
    };
    const auto work = [&](Watched& at) {
        while ((go_on || faults == 0) && double(now_ms()) < seconds * 1e3) {
            const uint64_t number = next++;
            if (number >= first + count) break;
            Random random(hash32(seed, static_cast<uint32_t>(number)));
            const Subject subject = subject_of(seed, number, random);
            current() = &subject;
            at.number = number;
            at.since_ms = now_ms() + 1;
            const std::string fault = fault_of(subject, random, tally);
            const uint64_t took_ms = now_ms() + 1 - at.since_ms;
            at.since_ms = 0;
            current() = nullptr;
            ++tally.lenses;
            const std::lock_guard lock(printing);
            if (took_ms > tally.slowest_ms) {
                tally.slowest_ms = took_ms;
                tally.slowest = number;
            }
            if (!fault.empty() && (faults++ == 0 || go_on)) print(subject, fault);
        }
        at.since_ms = UINT64_MAX;
    };
    std::vector<std::thread> workers;
    for (auto& at : watched) workers.emplace_back(work, std::ref(at));
    const auto busy = [&](const Watched& at) { return at.since_ms != UINT64_MAX; };
    for (uint64_t ticks = 1; std::any_of(watched.begin(), watched.end(), busy); ++ticks) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        for (const auto& at : watched) {
            const uint64_t since_ms = at.since_ms, now = now_ms();
            if (since_ms == 0 || since_ms == UINT64_MAX || now < since_ms + 120000) continue;
            fmt::print("FAULT: lens {} of seed {} takes over two minutes\n", at.number.load(),
                       seed);
            std::fflush(stdout);
            std::_Exit(1);
        }
        if (ticks % 600 == 0) {
            fmt::print("{} lenses, {} s, {} faults\n", tally.lenses.load(), now_ms() / 1000,
                       faults.load());
            std::fflush(stdout);
        }
    }
    for (auto& worker : workers) worker.join();
    fmt::print(
        "{} lenses of seed {} from {} in {} s: {} faults; {} std::invalid_argument\n"
        "{} rays, {} passed, {} have another status as Duals; {} cameras, {} lit; {} focused; "
        "slowest lens {}: {} ms\n",
        tally.lenses.load(), seed, first, now_ms() / 1000, faults.load(), tally.refused.load(),
        tally.rays.load(), tally.passed.load(), tally.differ.load(), tally.cameras.load(),
        tally.lit.load(), tally.focused.load(), tally.slowest.load(), tally.slowest_ms.load());
    return faults > 0;
}

}  // namespace
}  // namespace petzval

// The other sanitizer's, whose library does not know the former's callbacks.
extern "C" void __ubsan_on_report() {
    petzval::print_current();
}

int main(int argc, char** argv) {
    return petzval::run(argc, argv);
}
