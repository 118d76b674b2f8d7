// SPDX-License-Identifier: Apache-2.0
// A chart of cost against error, from the request to a folder that holds its report.
#pragma once

#include "apps/chart/chart_report.h"
#include "apps/chart/chart_run.h"
#include "apps/request/render_request.h"

namespace petzval::apps {

struct ChartRequest {
    ChartSubject subject;
    ChartFrame frame;
    std::vector<ChartAxis> axes;
    double budget_s = 600;
    std::optional<std::filesystem::path> reference;  ///< in place of those that are rendered
};

/// The request about the scene, size and part of the frame of a render's. folder_option: name of
/// the option that names the folder. Throws ValueError.
[[nodiscard]] ChartRequest chart_of(ChartRequest, const RenderRequest&,
                                    const std::string& folder_option);

struct ChartOutcome {
    size_t measured = 0;   ///< cases whose files are written
    bool stopped = false;  ///< the monitor said stop
};

/// Measures case by case and writes each when it is measured: the folder is whole at any time. A
/// case for which the time is too short is left out, with a remark, unless it is the only one. Ends
/// within 1.2 times the budget. `finished` sees each case. Throws InputError: faults of scene and
/// files, a folder that cannot be written; ArgumentError: a budget that is too small, more memory
/// than there is, nothing to compare.
[[nodiscard]] ChartOutcome run_chart(const ChartRequest&, integrator::TbbExecutor&,
                                     integrator::RenderMonitor&, const io::Notice& notice,
                                     const std::function<void(const MeasuredCase&)>& finished,
                                     const ChartClock&);

}  // namespace petzval::apps
