// SPDX-License-Identifier: Apache-2.0
#include "apps/chart/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "apps/request/option_text.h"
#include "apps/request/value_error.h"
#include "apps/setup/input_files.h"
#include "apps/setup/memory.h"
#include "apps/setup/spectral_wording.h"
#include "integrator/render/noise_cells.h"
#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/file/atomic_file.h"
#include "io/file/rescue.h"

namespace petzval::apps {
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
            throw io::OutputError(path.string(), "",
                                  "cannot be made a folder for the report: " +
                                      (error ? error.message() : "there is a file of that name"));
        io::check_writable(path / "report.html");
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

/// Refuses a folder whose files, which may be written anew, are among those that are read.
void refuse_overwriting_in(const fs::path& folder, const std::vector<io::NamedFile>& inputs) {
    constexpr std::array<std::string_view, 5> kWritten{".csv", ".html", ".json", ".png", ".svg"};
    std::vector<io::NamedFile> there;
    std::error_code error;
    for (const fs::path& of : {folder, folder / "pictures"})
        for (const auto& entry : fs::directory_iterator(of, error))
            if (std::find(kWritten.begin(), kWritten.end(), entry.path().extension().string()) !=
                kWritten.end())
                there.push_back({"the report", entry.path()});
    for (const io::NamedFile& one : there) io::refuse_overwriting({one}, inputs);
}

/// A noise is that of whole cells.
void leave_out_part_cells(ChartCase& of, const ChartFrame& frame) {
    const integrator::NoiseCells cells{frame.size};
    if (of.axis != ChartAxis::Noise || cells.whole_cells(frame.crop) == frame.crop) return;
    of.methods.clear();
    of.remarks.push_back(as_options("Left out: ⟨crop⟩ is not of whole cells of a noise; I/N is"));
}

void require_memory(const std::vector<ChartCase>& cases, const ChartFrame& frame) {
    double needed = 0;
    for (const ChartCase& of : cases) {
        double bytes = 0;
        for (const ChartMethod& method : of.methods) {
            const auto& bins = method.scene.spectral.bins;
            const Rect kept = Film::pixels_for(frame.crop, frame.size, method.keeps());
            bytes += double(kept.width()) * double(kept.height()) *
                     double(frame.seeds * Film::bytes_per_pixel(0, bins, method.keeps()));
            constexpr int kLevels = 20, kBytesOfPicture = 12;
            bytes += double(kLevels) * kBytesOfPicture * frame.crop.width() * frame.crop.height();
        }
        needed = std::max(needed, bytes);
    }
    if (const auto shortage = memory_shortage(needed))
        throw io::ArgumentError("⟨size⟩", "",
                                *shortage + "; give a smaller ⟨size⟩, a ⟨crop⟩ or fewer ⟨seeds⟩");
}

}  // namespace

ChartRequest chart_of(ChartRequest chart, const RenderRequest& render,
                      const std::string& folder_option) {
    // Endings of files: a folder that is named so was meant as one.
    constexpr std::array<std::string_view, 6> kFiles{".csv",  ".exr", ".html",
                                                     ".json", ".md",  ".png"};
    const std::filesystem::path& folder = chart.subject.folder;
    if (std::ranges::find(kFiles, io::lower(folder.extension().string())) != kFiles.end())
        throw ValueError(
            folder_option,
            fmt::format("a report is a folder, and \"{}\" is named as a file; call it {}",
                        folder.string(), (folder.parent_path() / folder.stem()).string()));
    if (render.scene.spectral.bins)
        throw ValueError("⟨bins⟩", "is for render; a chart's axis spectral has its own");
    check(render);
    chart.subject.request = resolved_scene(render);
    chart.frame.size = chart.subject.request.size;
    chart.frame.crop = pixels_of(render.crop, chart.frame.size);
    return chart;
}

ChartOutcome run_chart(const ChartRequest& request, integrator::TbbExecutor& executor,
                       integrator::RenderMonitor& monitor, const io::Notice& notice,
                       const std::function<void(const MeasuredCase&)>& finished,
                       const ChartClock& clock) {
    const double start_s = clock.wall_s();
    const auto elapsed_s = [&] { return clock.wall_s() - start_s; };
    const double least_s = kLeastChartBudget_s * static_cast<double>(request.axes.size());
    if (request.budget_s < least_s)
        throw io::ArgumentError("⟨budget⟩", "", "is too small: {} axes need {:g} s at least",
                                request.axes.size(), least_s);
    std::set<std::string> said;  // notices that one of the views gave
    const auto once = [&](const std::string& text) {
        if (said.insert(text).second) notice(text);
    };
    ChartFrame frame = request.frame;
    if (request.reference) {
        frame.reference = read_reference(*request.reference, frame.size, frame.crop);
        frame.reference_name = request.reference->filename().string();
    }
    std::vector<io::NamedFile> inputs = input_files(request.subject.request);
    if (request.reference) inputs.push_back({"the file of ⟨reference⟩", *request.reference});
    refuse_overwriting_in(request.subject.folder, inputs);
    Folder folder(request.subject.folder);
    const RenderSetup first =
        executor.inside([&] { return set_up_render(request.subject.request, once); });
    refuse_overwriting_in(request.subject.folder, first.prepared.files);
    for (const std::string& line : lines_of(first.from.spectral)) notice(line);
    const SetUpView open = [&](const SceneRequest& one) {
        return executor.inside([&] { return set_up_view(first, one, once); });
    };
    std::vector<ChartCase> cases = chart_cases(request.axes, request.subject, open);
    for (ChartCase& of : cases) leave_out_part_cells(of, frame);
    require_memory(cases, frame);
    const bool nothing = std::all_of(cases.begin(), cases.end(),
                                     [](const ChartCase& of) { return of.methods.empty(); });
    if (nothing) throw io::ArgumentError("⟨axis⟩", "", cases.front().remarks.front());

    double weight_left = 0;
    for (const ChartCase& of : cases) weight_left += of.methods.empty() ? 0 : of.weight;
    ChartReport report{request.subject, frame, request.budget_s, executor.threads(), {}};
    ChartOutcome outcome;
    std::string unwritten;  // why files of the report could not be written
    for (const ChartCase& of : cases) {
        const double share_s = (request.budget_s - elapsed_s()) * of.weight / weight_left;
        std::optional<MeasuredCase> measured;
        try {
            measured = measure(of, frame, share_s, executor, monitor, open, clock);
        } catch (const TooSlow& error) {
            if (cases.size() == 1) throw;
            measured.emplace().of = of;
            measured->of.methods.clear();
            measured->of.remarks.push_back(as_options(std::string("Left out: ") + error.what()));
        }
        if (!measured) {
            outcome.stopped = true;
            break;
        }
        if (!of.methods.empty()) weight_left -= of.weight;
        outcome.measured += !measured->methods.empty();
        report.cases.push_back(*std::move(measured));
        finished(report.cases.back());
        if (outcome.measured == 0) continue;
        folder.keep();
        try {
            io::attempt_all(
                {[&] { write_case(report, report.cases.back()); }, [&] { write_report(report); }});
        } catch (const io::InputError& error) {
            notice(std::string("warning: ") + error.what() + "; measuring goes on");
            unwritten = error.what();
        }
    }
    if (!unwritten.empty()) {
        const io::WriteOutcome points =
            io::write_or_rescue(request.subject.folder / "points.csv",
                                [&](const fs::path& to) { write_points(report, to); });
        throw io::OutputError(points.written() ? unwritten : points.message());
    }
    if (outcome.measured == 0 && !outcome.stopped)
        throw io::ArgumentError("⟨budget⟩", "", "is too small for each of the axes");
    return outcome;
}

}  // namespace petzval::apps
