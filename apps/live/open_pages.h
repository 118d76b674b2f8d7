// SPDX-License-Identifier: Apache-2.0
// The pages that are open, each with its view finder.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "apps/live/page_request.h"
#include "apps/live/saved_file.h"
#include "apps/live/viewer.h"

namespace petzval::apps {

/// Pages that may be open at once: a browser keeps six connections to a server, of which each page
/// takes one. They share the scene; each has a picture of its own.
inline constexpr size_t kMostPages = 5;

/// All functions may be called from any thread. Throws ValueError for a page that is not known.
class OpenPages {
  public:
    /// order: what every page begins with.
    explicit OpenPages(RenderOrder order) : rules_(rules_of(std::move(order))) {}

    /// Name of a page that opens: the one that it wants, if that has closed and nobody took its
    /// place, so that it finds its picture; else a new one. Empty where kMostPages are open.
    [[nodiscard]] std::string open(const std::string& wanted);
    /// Stops the work for a page. It is known until others need its place.
    void close(const std::string& page);

    [[nodiscard]] std::shared_ptr<Viewer> viewer_of(const std::string& page);
    /// Rules of the requests of all pages.
    [[nodiscard]] const PageRules& rules() const { return rules_; }
    /// Rules of the requests of a page, which may name the lenses that were kept for it.
    [[nodiscard]] PageRules rules_for(const std::string& page);
    /// Keeps the text of a lens file as long as the page is known, and returns its name: a new one
    /// each time, so that no picture is of another lens than its name says. Throws OutputError.
    [[nodiscard]] std::filesystem::path keep_lens(const std::string& page, const std::string& text);

  private:
    struct Page {
        std::shared_ptr<Viewer> viewer;
        std::shared_ptr<OwnFolder> folder;  ///< of changed lenses; nullptr: none yet
        bool connected = false;
        uint64_t closed = 0;  ///< the how many-th that closed
    };
    [[nodiscard]] Page& page_of(const std::string& page);

    const PageRules rules_;
    std::mutex mutex_;  ///< of what follows
    std::map<std::string, Page> pages_;
    uint64_t closings_ = 0, lenses_ = 0;
    SharedScene scene_;  ///< for the page that opens next
};

}  // namespace petzval::apps
