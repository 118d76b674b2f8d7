// SPDX-License-Identifier: Apache-2.0
#include "apps/chart/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "apps/setup/memory.h"
#include "apps/setup/spectral_wording.h"
#include "io/base/atomic_file.h"
#include "io/base/error.h"

namespace petzval {
namespace {

namespace fs = std::filesystem;

/// The report's folder. One that was made here is removed again unless keep() was called.
class Folder {
  public:
    explicit Folder(const fs::path& path) : path_(path) {
        std::error_code error;
        if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
        made_ = fs::create_directory(path, error);
        if (!fs::is_directory(path))
            throw InputError(path.string(), "",
                             "cannot be made a folder for the report: " +
                                 (error ? error.message() : "there is a file of that name"));
        check_writable(path / "report.html");
        made_pictures_ = fs::create_directory(path / "pictures", error);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
        std::error_code ignored;
        if (kept_) return;
        if (made_)
            fs::remove_all(path_, ignored);
        else if (made_pictures_)
            fs::remove(path_ / "pictures", ignored);
    }
    void keep() { kept_ = true; }

  private:
    fs::path path_;
    bool made_ = false, made_pictures_ = false, kept_ = false;
};

void require_memory(const std::vector<ChartCase>& cases, const ChartFrame& frame) {
    double most = 0;
    for (const ChartCase& of : cases) {
        double per_pixel = 0;
        for (const ChartMethod& method : of.methods) {
            const auto& bins = method.scene.spectral.bins;
            per_pixel += double(frame.seeds * Film::bytes_per_pixel(0, bins));
            per_pixel += 12 * 20;  // pictures of the levels
        }
        most = std::max(most, per_pixel);
    }
    const double needed = most * frame.crop.width() * frame.crop.height();
    if (const auto shortage = memory_shortage(needed))
        throw ArgumentError("--size", "",
                            *shortage + "; give a smaller --size, a --crop or fewer --seeds");
}

}  // namespace

ChartOutcome run_chart(const ChartRequest& request, TbbExecutor& executor, RenderMonitor& monitor,
                       const Notice& notice,
                       const std::function<void(const MeasuredCase&)>& finished,
                       const ChartClock& clock) {
    const double start_s = clock.wall_s();
    const auto elapsed_s = [&] { return clock.wall_s() - start_s; };
    const double least_s = kLeastChartBudget_s * static_cast<double>(request.axes.size());
    if (request.budget_s < least_s)
        throw ArgumentError("--budget", "",
                            fmt::format("is too small: {} axes need {:g} s at least",
                                        request.axes.size(), least_s));
    std::set<std::string> said;  // notices that one of the views gave
    const auto once = [&](const std::string& text) {
        if (said.insert(text).second) notice(text);
    };
    ChartFrame frame = request.frame;
    if (request.reference) {
        frame.reference = read_reference(*request.reference, frame.size, frame.crop);
        frame.reference_name = request.reference->filename().string();
    }
    Folder folder(request.subject.folder);
    const RenderSetup first =
        executor.inside([&] { return set_up_render(request.subject.request, once); });
    for (const std::string& line : lines_of(first.from.spectral)) notice(line);
    const SetUpView open = [&](const SceneRequest& one) {
        return executor.inside([&] { return set_up_view(first, one, once); });
    };
    const std::vector<ChartCase> cases = chart_cases(request.axes, request.subject, open);
    require_memory(cases, frame);
    const bool nothing = std::all_of(cases.begin(), cases.end(),
                                     [](const ChartCase& of) { return of.methods.empty(); });
    if (nothing) throw ArgumentError("--axis", "", cases.front().remarks.front());

    double weight_left = 0;
    for (const ChartCase& of : cases) weight_left += of.methods.empty() ? 0 : of.weight;
    ChartReport report{request.subject, frame, request.budget_s, executor.threads(), {}};
    ChartOutcome outcome;
    for (const ChartCase& of : cases) {
        const double share_s = (request.budget_s - elapsed_s()) * of.weight / weight_left;
        std::optional<MeasuredCase> measured;
        try {
            measured = measure(of, frame, share_s, executor, monitor, open, clock);
        } catch (const TooSlow& error) {
            if (cases.size() == 1) throw;
            measured.emplace().of = of;
            measured->of.methods.clear();
            measured->of.remarks.push_back(std::string("Left out: ") + error.what());
        }
        if (!measured) {
            outcome.stopped = true;
            return outcome;
        }
        if (!of.methods.empty()) weight_left -= of.weight;
        outcome.measured += !measured->methods.empty();
        report.cases.push_back(*std::move(measured));
        finished(report.cases.back());
        if (outcome.measured == 0) continue;
        folder.keep();
        write_case(report, report.cases.back());
        write_report(report);
    }
    if (outcome.measured == 0)
        throw ArgumentError("--budget", "", "is too small for each of the axes");
    return outcome;
}

}  // namespace petzval
