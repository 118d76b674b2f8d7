// SPDX-License-Identifier: Apache-2.0
#include "apps/chart/chart_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/plan/noise_setup.h"
#include "apps/setup/develop.h"
#include "apps/setup/tracer.h"
#include "integrator/render/render.h"
#include "integrator/render/render_to_noise.h"
#include "io/image/difference.h"
#include "io/image/picture_files.h"
#include "io/image/symmetric_mse.h"

namespace petzval::apps {
namespace {

constexpr double kReferenceShare = 0.4;  ///< at most; counts that grow in steps use 0.25 to 0.4
constexpr double kMeasuringShare = 0.9;  ///< the rest is for plots and pictures

/// Wall time since it was made.
class Stopwatch {
  public:
    explicit Stopwatch(const ChartClock& clock) : clock_(clock), start_s_(clock.wall_s()) {}
    [[nodiscard]] double elapsed_s() const { return clock_.wall_s() - start_s_; }

  private:
    const ChartClock& clock_;
    double start_s_;
};

/// What all renders of a chart share.
struct ChartContext {
    const ChartFrame& frame;
    integrator::TbbExecutor& executor;
    integrator::RenderMonitor& monitor;
    const ChartClock& clock;
};

/// One method's renders of several seeds, all at the same number of samples.
class MethodRenders {
  public:
    MethodRenders(const ChartMethod& method, RenderSetup setup, const ChartContext& at,
                  uint32_t first_seed, uint32_t seeds)
        : keeps_(method.keeps()),
          job_(method.job),
          setup_(std::move(setup)),
          at_(at),
          first_seed_(first_seed) {
        job_.observer = setup_.view.observer;
        tracer_.emplace(tracer_of(setup_, {}));
        const double start_s = at_.clock.cpu_s();
        if (keeps_.blocks) noise_ = noise_target(setup_, job_, {}, at_.frame.size, 1, at_.executor);
        cpu_s_.resize(seeds, at_.clock.cpu_s() - start_s);
        for (uint32_t i = 0; i < seeds; ++i) films_.push_back(new_film());
    }

    /// Continues one seed's render; false where it was stopped.
    [[nodiscard]] bool advance(uint32_t seed, uint32_t end_sample) {
        return render_into(films_[seed], seed, end_sample, cpu_s_[seed]);
    }
    /// The picture of a seed, with the CPU time of its render and of what makes the picture of it;
    /// nothing where it was stopped.
    struct Shown {
        io::Picture picture;
        double cpu_s;
    };
    [[nodiscard]] std::optional<Shown> shown(uint32_t i) const {
        const double start_s = at_.clock.cpu_s();
        std::shared_ptr<const DenoisedFilm> denoised;
        if (keeps_.halves) {
            denoised = denoised_film(films_[i], at_.executor, at_.monitor.stop);
            if (!denoised) return std::nullopt;
        }
        const double denoising_s = at_.clock.cpu_s() - start_s;
        return Shown{colours_of(films_[i], 3, denoised.get()), cpu_s_[i] + denoising_s};
    }
    /// After all seeds have been advanced there.
    void reached(uint32_t samples) { samples_ = samples; }
    /// One sample of each pixel that counts for nothing: it fills caches and tells the time.
    [[nodiscard]] bool warm_up() {
        Film scratch = new_film();
        double ignored_s = 0;
        return render_into(scratch, 0, 1, ignored_s);
    }

    [[nodiscard]] uint32_t samples() const { return samples_; }
    /// Of the next level; each half of a film has a sample.
    [[nodiscard]] uint32_t next_samples() const {
        return std::max(keeps_.halves ? kHalves : 1, 2 * samples_);
    }
    /// Of a pixel, on average over the seeds.
    [[nodiscard]] uint32_t mean_samples() const {
        double sum = 0;
        for (const Film& film : films_) sum += double(film.taken_count());
        const Rect pixels = films_.front().pixels();
        return static_cast<uint32_t>(
            std::lround(sum / double(films_.size()) / pixels.width() / pixels.height()));
    }
    [[nodiscard]] uint32_t seed_count() const { return static_cast<uint32_t>(films_.size()); }
    [[nodiscard]] uint32_t seed(uint32_t i) const { return first_seed_ + i; }

    double spent_s = 0, last_s = 0;  ///< wall time of all turns, and of the last level
    [[nodiscard]] double next_s() const { return 2.1 * last_s; }

  private:
    [[nodiscard]] Film new_film() const {
        return {at_.frame.size, at_.frame.crop, {}, setup_.view.observer.bins(), keeps_};
    }
    bool render_into(Film& film, uint32_t seed, uint32_t end, double& cpu_s) {
        integrator::RenderJob job = job_;
        job.seed = first_seed_ + seed;
        job.end_sample = end;
        const camera::Camera& camera = *setup_.view.camera;
        const double start_s = at_.clock.cpu_s();
        integrator::RenderResult result;
        if (noise_) {
            constexpr uint32_t kMostOfLevel = 64;  // times as many as other pictures have
            auto level = std::make_shared<integrator::NoiseTarget>(*noise_);
            level->noise = 1 / std::sqrt(double(end));
            job.noise = level;
            job.end_sample = std::max(integrator::kLeastOfCell, kMostOfLevel * end);
            result =
                integrator::render_to_noise(*tracer_, camera, job, film, at_.executor, at_.monitor);
        } else {
            result = integrator::render(*tracer_, camera, job, film, at_.executor, at_.monitor);
        }
        cpu_s += at_.clock.cpu_s() - start_s;
        return !result.stopped;
    }

    FilmKeeps keeps_;
    integrator::RenderJob job_;
    RenderSetup setup_;
    const ChartContext& at_;
    uint32_t first_seed_, samples_ = 0;
    std::shared_ptr<const integrator::NoiseTarget> noise_;  ///< empty: numbers of samples
    std::optional<integrator::PathTracer<>> tracer_;
    std::vector<Film> films_;
    std::vector<double> cpu_s_;
};

io::Picture mean_of(const std::vector<io::Picture>& parts) {
    io::Picture mean = parts.front();
    for (size_t i = 0; i < mean.pixels.size(); ++i) {
        double sum = 0;
        for (const io::Picture& part : parts) sum += double(part.pixels[i]);
        mean.pixels[i] = static_cast<float>(sum / static_cast<double>(parts.size()));
    }
    return mean;
}

/// Mean of the variance of the parts' mean, over what the symmetric MSE divides by.
double symmetric_variance(const std::vector<io::Picture>& parts, double floor) {
    const auto n = static_cast<double>(parts.size());
    double total = 0;
    for (size_t i = 0; i < parts.front().pixels.size(); ++i) {
        const auto value = [i](const io::Picture& part) { return double(part.pixels[i]); };
        double sum = 0, variance = 0;
        for (const io::Picture& part : parts) sum += value(part);
        // From each two parts, over the mean of the others: a part that is too bright by chance
        // would hide its own error where it were in both.
        for (auto j = parts.begin(); j != parts.end(); ++j)
            for (auto k = std::next(j); k != parts.end(); ++k) {
                const double difference = value(*j) - value(*k);
                const double others = (sum - value(*j) - value(*k)) / (n - 2);
                const double scale = others * others + floor * floor;
                if (scale > 0) variance += difference * difference / scale / (n * (n - 1)) / n;
            }
        total +=
            std::min(variance, io::kMostSymmetricMse);  // no pixel adds more to what is measured
    }
    return total / static_cast<double>(parts.front().pixels.size());
}

/// Mean of the variance of the parts' mean, over what the relative MSE divides by.
double relative_variance(const std::vector<io::Picture>& parts, const io::Picture& mean) {
    const auto n = static_cast<double>(parts.size());
    double sum = 0;
    for (size_t i = 0; i < mean.pixels.size(); ++i) {
        const double m = double(mean.pixels[i]);
        double squares = 0;
        for (const io::Picture& part : parts) squares += std::pow(double(part.pixels[i]) - m, 2);
        sum += squares / (n - 1) / n / (m * m + io::kRelativeMseEpsilon);
    }
    return sum / static_cast<double>(mean.pixels.size());
}

/// once_s: what one sample of everything will take.
void require_time(double once_s, double budget_s, const char* what) {
    if (once_s <= budget_s) return;
    throw TooSlow("⟨budget⟩", "",
                  "is too small: the first samples of {} take {:.0f} s, and {:.0f} s are there for "
                  "them; give more time or a smaller ⟨size⟩",
                  what, once_s, std::max(budget_s, 0.));
}

std::optional<ChartReference> render_reference(const ChartMethod& method, RenderSetup setup,
                                               const ChartContext& at, double budget_s) {
    const Stopwatch clock(at.clock);
    MethodRenders renders(method, std::move(setup), at, kFirstReferenceSeed, kReferenceReplicates);
    if (!renders.warm_up()) return std::nullopt;
    // A film with replicates is whole after one sample of each.
    const uint32_t first = std::max(2u, method.job.replicates);
    require_time(clock.elapsed_s() * (1 + first * kReferenceReplicates), budget_s, "the reference");
    for (uint32_t end = first; end <= 1u << 20;) {
        const Stopwatch level(at.clock);
        for (uint32_t part = 0; part < kReferenceReplicates; ++part)
            if (!renders.advance(part, end)) return std::nullopt;
        renders.last_s = level.elapsed_s() * end / (end - renders.samples());
        renders.reached(end);
        const double left_s = budget_s - clock.elapsed_s();
        if (renders.last_s <= left_s)
            end *= 2;
        else if (renders.last_s / 2 <= left_s)
            end += end / 2;
        else
            break;
    }
    std::vector<io::Picture> parts;
    double cpu_s = 0;
    for (uint32_t i = 0; i < kReferenceReplicates; ++i) {
        auto part = renders.shown(i);
        if (!part) return std::nullopt;
        parts.push_back(std::move(part->picture));
        cpu_s += part->cpu_s;
    }
    ChartReference reference = reference_of(parts, at.frame.exposure_ev);
    reference.samples = renders.samples();
    reference.cpu_s = cpu_s;
    return reference;
}

/// Renders and errors of the methods of one case, which take turns until their time is up.
class CaseMeasurement {
  public:
    CaseMeasurement(const ChartCase& of, const ChartContext& at, const ChartReference& reference,
                    const SetUpView& open)
        : at_(at), reference_(reference), flip_(reference.picture, at.frame.exposure_ev) {
        for (const ChartMethod& method : of.methods) {
            renders_.emplace_back(method, open(method.scene), at, 0, at.frame.seeds);
            methods_.emplace_back().name = method.name;
        }
        pictures_.resize(renders_.size());
    }

    /// False where it was stopped.
    [[nodiscard]] bool run(double budget_s) {
        const Stopwatch clock(at_.clock);
        double first_level_s = 0;
        for (MethodRenders& renders : renders_) {
            const Stopwatch one(at_.clock);
            if (!renders.warm_up()) return false;
            first_level_s += one.elapsed_s() * at_.frame.seeds * renders.next_samples();
        }
        require_time(clock.elapsed_s() + first_level_s, budget_s, "all methods");
        const double share_s = budget_s / static_cast<double>(renders_.size());
        for (;;) {
            const auto next = chosen(share_s, budget_s - clock.elapsed_s());
            if (next.empty()) return true;
            if (!level(next)) return false;
        }
    }

    [[nodiscard]] std::vector<MeasuredMethod> result(std::optional<double>& equal_cpu_s) && {
        double shared_s = INFINITY;
        for (const MeasuredMethod& m : methods_)
            shared_s = std::min(shared_s, m.points.back().cpu_s().mean);
        for (size_t i = 0; i < methods_.size(); ++i) {
            MeasuredMethod& m = methods_[i];
            const auto off = [&](const ChartPoint& p) {
                return std::fabs(std::log(std::max(p.cpu_s().mean, 1e-9) / shared_s));
            };
            const auto nearest =
                std::min_element(m.points.begin(), m.points.end(),
                                 [&](const auto& a, const auto& b) { return off(a) < off(b); });
            m.shown = static_cast<size_t>(nearest - m.points.begin());
            m.picture = std::move(pictures_[i][m.shown]);
            m.flip_map = flip_.map(m.picture);
        }
        equal_cpu_s = shared_s;
        return std::move(methods_);
    }

  private:
    /// Who goes on: all whose next level fits into their share of the time; when there is none any
    /// more, those that fit into what is left, the quickest first.
    [[nodiscard]] std::vector<size_t> chosen(double share_s, double left_s) const {
        std::vector<size_t> order;
        for (size_t i = 0; i < renders_.size(); ++i)
            if (renders_[i].samples() < 1u << 20) order.push_back(i);
        std::sort(order.begin(), order.end(),
                  [&](size_t a, size_t b) { return renders_[a].next_s() < renders_[b].next_s(); });
        const bool any_in_share = std::any_of(order.begin(), order.end(), [&](size_t i) {
            return renders_[i].spent_s + renders_[i].next_s() <= share_s;
        });
        std::vector<size_t> next;
        for (const size_t i : order) {
            const MethodRenders& renders = renders_[i];
            if (any_in_share && renders.spent_s + renders.next_s() > share_s) continue;
            if (renders.next_s() > left_s) break;
            left_s -= renders.next_s();
            next.push_back(i);
        }
        return next;
    }

    /// Doubles the samples of those, seed by seed in turn, as the machine's speed drifts.
    [[nodiscard]] bool level(const std::vector<size_t>& next) {
        for (const size_t i : next) renders_[i].last_s = 0;
        for (uint32_t seed = 0; seed < at_.frame.seeds; ++seed)
            for (size_t k = 0; k < next.size(); ++k) {
                MethodRenders& renders = renders_[next[(k + seed) % next.size()]];
                const Stopwatch turn(at_.clock);
                if (!renders.advance(seed, renders.next_samples())) return false;
                renders.last_s += turn.elapsed_s();
            }
        for (const size_t i : next) {
            MethodRenders& renders = renders_[i];
            const Stopwatch turn(at_.clock);
            renders.reached(renders.next_samples());
            ChartPoint point{renders.mean_samples(), {}};
            for (uint32_t seed = 0; seed < at_.frame.seeds; ++seed) {
                auto shown = renders.shown(seed);
                if (!shown) return false;
                ChartSeed& measured =
                    point.seeds.emplace_back(errors_of(shown->picture, reference_.picture, flip_));
                measured.seed = renders.seed(seed);
                measured.cpu_s = shown->cpu_s;
                if (seed == 0) pictures_[i].push_back(std::move(shown->picture));
            }
            methods_[i].points.push_back(std::move(point));
            renders.last_s += turn.elapsed_s();
            renders.spent_s += renders.last_s;
        }
        return true;
    }

    const ChartContext& at_;
    const ChartReference& reference_;
    io::Flip flip_;
    std::vector<MethodRenders> renders_;
    std::vector<MeasuredMethod> methods_;
    std::vector<std::vector<io::Picture>> pictures_;  ///< of the first seed, at each level
};

}  // namespace

bool MeasuredCase::believed(const ChartPoint& point) const {
    return !reference.symmetric_mse || point.symmetric_mse().mean >= 2 * *reference.symmetric_mse;
}

ChartSeed errors_of(const io::Picture& picture, const io::Picture& reference,
                    const io::Flip& flip) {
    const io::LayerDifference rgb = io::compare(picture, reference).front();
    return {.symmetric_mse = rgb.symmetric_mse.value(),
            .relative_mse = rgb.relative_mse,
            .flip = flip.mean(picture)};
}

ChartReference reference_of(const std::vector<io::Picture>& parts, float exposure_ev) {
    ChartReference reference;
    reference.parts = static_cast<uint32_t>(parts.size());
    reference.picture = mean_of(parts);
    reference.symmetric_mse =
        symmetric_variance(parts, io::floor_against(reference.picture).value());
    reference.relative_mse = relative_variance(parts, reference.picture);
    const auto middle = parts.begin() + static_cast<long>(parts.size() / 2);
    reference.flip = io::Flip(mean_of({parts.begin(), middle}), exposure_ev)
                         .mean(mean_of({middle, parts.end()}));
    return reference;
}

io::Picture read_reference(const std::filesystem::path& path, V2i size, Rect crop) {
    const io::Picture read = io::read_picture(path);
    if (read.for_display)
        throw io::InputError(path.string(), "",
                             "holds values for a display, not light; give a rendered EXR");
    io::Picture picture = colours_of(Film(size, crop, {}), 3);
    const std::array<int, 3> from{io::channel_index(read, "R"), io::channel_index(read, "G"),
                                  io::channel_index(read, "B")};
    if (*std::min_element(from.begin(), from.end()) < 0)
        throw io::InputError(path.string(), "", "has no channels R, G and B; give a rendered EXR");
    if (read.width != picture.width || read.height != picture.height || read.x != picture.x ||
        read.y != picture.y || read.full_width != size.x || read.full_height != size.y)
        throw io::InputError(path.string(), "",
                             "has {}x{} pixels from {},{} of {}x{}, and the chart {}x{} "
                             "from {},{} of {}x{}; give the same ⟨size⟩ and ⟨crop⟩",
                             read.width, read.height, read.x, read.y, read.full_width,
                             read.full_height, picture.width, picture.height, picture.x, picture.y,
                             size.x, size.y);
    for (size_t i = 0; i < picture.pixels.size() / 3; ++i)
        for (size_t c = 0; c < 3; ++c)
            picture.pixels[3 * i + c] =
                read.pixels[i * read.channels.size() + static_cast<size_t>(from[c])];
    return picture;
}

std::optional<MeasuredCase> measure(const ChartCase& of, const ChartFrame& frame, double budget_s,
                                    integrator::TbbExecutor& executor,
                                    integrator::RenderMonitor& monitor, const SetUpView& open,
                                    const ChartClock& times) {
    const Stopwatch clock(times);
    MeasuredCase out;
    out.of = of;
    if (of.methods.empty()) return out;
    require_time(0, budget_s, "this axis");
    const ChartContext at{frame, executor, monitor, times};
    const double measuring_s = kMeasuringShare * budget_s;
    if (frame.reference) {
        out.reference.picture = *frame.reference;
    } else {
        auto reference = render_reference(of.reference, open(of.reference.scene), at,
                                          kReferenceShare * budget_s);
        if (!reference) return std::nullopt;
        out.reference = *std::move(reference);
    }
    CaseMeasurement measurement(out.of, at, out.reference, open);
    if (!measurement.run(measuring_s - clock.elapsed_s())) return std::nullopt;
    out.methods = std::move(measurement).result(out.equal_cpu_s);
    out.wall_s = clock.elapsed_s();
    return out;
}

}  // namespace petzval::apps
