// SPDX-License-Identifier: Apache-2.0
#include "apps/live/open_pages.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/live/guard.h"
#include "apps/request/value_error.h"
#include "io/file/atomic_file.h"

namespace petzval::apps {

OpenPages::Page& OpenPages::page_of(const std::string& page) {
    const auto found = pages_.find(page);
    if (found == pages_.end()) throw ValueError("page", "is not connected; load it again");
    return found->second;
}

std::string OpenPages::open(const std::string& wanted) {
    Page gone;  // ends without the lock
    const std::lock_guard lock(mutex_);
    if (const auto found = pages_.find(wanted); found != pages_.end() && !found->second.connected) {
        found->second.connected = true;
        return wanted;
    }
    if (pages_.size() >= kMostPages) {
        const auto oldest = std::ranges::min_element(pages_, {}, [](const auto& page) {
            return page.second.connected ? UINT64_MAX : page.second.closed;
        });
        if (oldest->second.connected) return "";
        gone = std::move(oldest->second);
        pages_.erase(oldest);
    }
    const std::string page = random_token();
    pages_[page] = {std::make_shared<Viewer>(threads_of(rules_.start.run), scene_), nullptr, true,
                    0};
    return page;
}

void OpenPages::close(const std::string& page) {
    const std::lock_guard lock(mutex_);
    Page& closed = page_of(page);
    if (SharedScene scene = closed.viewer->scene(); scene.loaded.prepared.scene)
        scene_ = std::move(scene);
    closed.viewer->leave();
    closed.connected = false;
    closed.closed = ++closings_;
}

std::shared_ptr<Viewer> OpenPages::viewer_of(const std::string& page) {
    const std::lock_guard lock(mutex_);
    return page_of(page).viewer;
}

PageRules OpenPages::rules_for(const std::string& page) {
    const std::lock_guard lock(mutex_);
    PageRules rules = rules_;
    if (const auto& folder = page_of(page).folder) rules.folders.push_back(folder->path());
    return rules;
}

std::filesystem::path OpenPages::keep_lens(const std::string& page, const std::string& text) {
    std::shared_ptr<OwnFolder> folder;
    uint64_t number = 0;
    {
        const std::lock_guard lock(mutex_);
        Page& of = page_of(page);
        if (!of.folder) of.folder = std::make_shared<OwnFolder>();
        folder = of.folder;
        number = ++lenses_;
    }
    const auto file = folder->path() / fmt::format("lens-{}.json", number);
    io::write_file_atomically(file, text);
    return file;
}

}  // namespace petzval::apps
