// The page of `planetree view` as a reader sees it, in a browser without a window.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "tests/tools/html/browser.h"
#include "tests/tools/view/scene_fixture.h"
#include "tools/view/embedded_files.h"
#include "tools/view/model_source.h"
#include "tools/view/scene_source.h"
#include "tools/view/view_server.h"

namespace planetree::tools {
namespace {

/// Runs before the page's scripts.
constexpr const char* kWatchPage = R"js(
window.seen = [];
addEventListener('error', (event) => seen.push('error: ' + event.message));
addEventListener('unhandledrejection', (event) => seen.push('rejection: ' + event.reason));
addEventListener('securitypolicyviolation', (event) => seen.push('policy: ' + event.blockedURI));
for (const kind of ['error', 'warn'])
  console[kind] = (...words) => seen.push(kind + ': ' + words.join(' '));
)js";

/// Runs after them: does what a reader does, and reports.
constexpr const char* kUsePage = R"js(
const byId = (id) => document.getElementById(id), stage = byId('stage');
const until = async (test) => {
  for (let i = 0; i < 200 && !test(); ++i) await new Promise((resolve) => setTimeout(resolve, 20));
  return test();
};
const place = () => ['x', 'y', 'z'].map((id) => Number(byId(id).value));
const text = (id) => byId(id).textContent;
const apart = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));
const press = (key) => stage.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true}));
const pointer = (type, x, y) => stage.querySelector('canvas').dispatchEvent(new PointerEvent(type, {
  pointerId: 1, isPrimary: true, button: 0, pointerType: 'mouse', clientX: x, clientY: y, bubbles: true, cancelable: true}));
const report = {};
const moves = async (act) => {
  const before = place(), answer = text('answer');
  act();
  const changed = await until(() => text('answer') !== answer && apart(place(), before) > 0);
  return changed ? apart(place(), before) : 0;
};
const drag = async () => {
  const box = stage.getBoundingClientRect();
  for (let y = box.top + 4; y < box.bottom; y += 12)
    for (let x = box.left + 4; x < box.right; x += 12) {
      pointer('pointermove', x, y);
      if (!stage.classList.contains('near')) continue;
      return moves(() => {
        pointer('pointerdown', x, y);
        pointer('pointermove', x - 30, y + 10);
        pointer('pointerup', x - 30, y + 10);
      });
    }
  return -1;
};
try {
  report.answered = await until(() => text('answer').includes('exact'));
  report.hasPicture = Boolean(stage.querySelector('canvas'));
  if (report.hasPicture) report.drawn = await until(() => / (392|400) triangles$/.test(text('drawn')));
  report.byKey = await moves(() => press('ArrowRight'));
  report.byOtherKey = await moves(() => press('PageUp'));
  if (report.hasPicture) report.byDrag = await drag();
  report.byField = await moves(() => {
    byId('x').value = -20;
    byId('x').dispatchEvent(new Event('input'));
  });
  report.answer = text('answer');
  report.instances = !byId('instances').hidden;
  if (report.instances) {
    const rows = byId('instance-list').tBodies[0].rows, last = rows[rows.length - 1];
    report.names = [...rows].map((row) => row.cells[0].textContent);
    report.byButton = await moves(() => last.querySelector('button').click());
    report.marked = await until(() => last.hasAttribute('aria-current'));
    report.nearestInstance = text('nearest-instance');
    report.models = [...byId('model-list').tBodies[0].rows].map((row) => row.textContent);
    report.answer = text('answer');
  }
  report.colours = [...byId('colour').options].map((option) => option.text);
  if (report.hasPicture) {
    byId('colour').value = byId('colour').options[byId('colour').options.length - 1].value;
    byId('colour').dispatchEvent(new Event('change'));
  }
  report.spoken = await until(() => !text('spoken').startsWith('Waiting')) && text('spoken');
  report.pages = await until(() => text('pages').includes('in memory')) && byId('levels').rows.length;
  report.states = !byId('levels').hidden && !byId('strip').hidden;
  report.explanation = byId('no-picture').hidden ? '' : text('no-picture');
  report.title = document.title;
  report.timeline = !byId('timeline').hidden;
  report.alert = byId('alert').hidden ? '' : text('alert');
  report.scrollWidth = document.documentElement.scrollWidth;
  report.isDark = matchMedia('(prefers-color-scheme: dark)').matches;
  report.policy = getComputedStyle(document.body).backgroundColor;
  report.unlabelled = [...document.querySelectorAll('input, select, button, [role=img], meter')]
    .filter((part) => !part.labels?.length && !part.getAttribute('aria-label') && !part.textContent.trim()).length;
} catch (error) {
  seen.push('error: ' + error.stack);
}
const requests = performance.getEntriesByType('resource').map((entry) => entry.name)
  .filter((name) => !name.startsWith(location.href));
document.body.setAttribute('data-visit', encodeURIComponent(JSON.stringify({report, complaints: seen, requests})));
)js";

class ViewPage : public SceneFiles {
 protected:
  void SetUp() override {
    if (!Browser::is_here()) GTEST_SKIP() << Browser::kMissing;
    SceneFiles::SetUp();
    auto source = ModelSource::open("tree.ptree", std::uint64_t{64} << 20);
    ASSERT_TRUE(source) << source.error().text;
    model_ = source->get();
    source_ = *std::move(source);
  }
  void open_scene() {
    SceneFailure failure;
    source_ = SceneSource::open("scene.json", std::nullopt, failure);
    ASSERT_TRUE(source_) << failure.error.text;
  }
  static bool has_three() {
    return std::ranges::any_of(embedded_files(),
                               [](const PageFile& file) { return file.name == "three.module.js"; });
  }
  /// Serves the page with two scripts added, and opens it.
  nlohmann::json used(const BrowserWindow& window, bool with_three = true) {
    std::vector<PageFile> files(embedded_files().begin(), embedded_files().end());
    if (!with_three) {
      std::erase_if(files, [](const PageFile& file) {
        return file.name == "built.js" || file.name.starts_with("three.");
      });
      files.push_back({"built.js", "text/javascript", "export const hasPicture = false;"});
    }
    std::string html(files.front().bytes);
    html.insert(html.find("<script"), "<script src=\"watch.js\"></script>");
    html.insert(html.find("</body>"), "<script type=\"module\" src=\"use.js\"></script>");
    files.front().bytes = html;
    files.push_back({"watch.js", "text/javascript", kWatchPage});
    files.push_back({"use.js", "text/javascript", kUsePage});
    const auto server = ViewServer::start({}, files, *source_);
    EXPECT_TRUE(server);
    const std::string page = (*server)->pages().at(0);
    BrowserVisit visit = Browser::visit_address(page, page, window, 30000, folder_ / ".");
    for (const std::string& complaint : visit.complaints) ADD_FAILURE() << complaint;
    for (const std::string& request : visit.requests) ADD_FAILURE() << "asks for " << request;
    return visit.report;
  }
  static void expect_used(const nlohmann::json& report, const std::string& file = "tree.ptree") {
    ASSERT_TRUE(report.is_object());
    EXPECT_EQ(report["answered"], true);
    EXPECT_GT(report["byKey"], 0.0);
    EXPECT_GT(report["byOtherKey"], 0.0);
    EXPECT_GT(report["byField"], 1.0);
    for (const char* word : {"distance", "interval", "normal", "side", "triangle", "contacts"})
      EXPECT_NE(std::string(report["answer"]).find(word), std::string::npos) << word;
    EXPECT_NE(std::string(report["spoken"]).find("from the surface"), std::string::npos);
    EXPECT_EQ(report["states"], file == "tree.ptree");
    EXPECT_EQ(report["instances"], file != "tree.ptree");
    EXPECT_EQ(report["title"], file + " - planetree view");
    EXPECT_EQ(report["alert"], "");
    EXPECT_EQ(report["unlabelled"], 0);
  }

  static void expect_scene(const nlohmann::json& report) {
    expect_used(report, "scene.json");
    EXPECT_EQ(report["names"], Json({"solid #0", "turned", "mesh #2"}));
    EXPECT_GT(report["byButton"], 1.0);
    EXPECT_EQ(report["marked"], true);
    EXPECT_EQ(report["nearestInstance"], "mesh #2");
    EXPECT_NE(std::string(report["answer"]).find("instancemesh #2"), std::string::npos);
    ASSERT_EQ(report["models"].size(), 2u);
    EXPECT_NE(std::string(report["models"][1]).find("distance"), std::string::npos);
  }

  std::unique_ptr<ViewSource> source_;
  ModelSource* model_ = nullptr;
};

TEST_F(ViewPage, ShowsAModelAndMovesTheProbeInWindowsOfAnyWidthInBothThemes) {
  if (!has_three()) GTEST_SKIP() << "built without three.js";
  for (const int width : {390, 1440}) {
    const bool is_dark = width == 390;
    const auto report = used({width, is_dark, true});
    expect_used(report);
    if (HasFatalFailure()) return;
    EXPECT_EQ(report["hasPicture"], true);
    EXPECT_EQ(report["drawn"], true);
    EXPECT_GT(report["byDrag"], 0.0);
    EXPECT_LE(report["scrollWidth"], width) << "the page scrolls sideways";
    EXPECT_EQ(report["isDark"], is_dark);
    EXPECT_EQ(report["timeline"], false);
    EXPECT_GE(report["pages"], 2) << "a head and a row";
    EXPECT_EQ(report["colours"], Json({"surface", "side", "level", "pages in memory"}));
  }
}

TEST_F(ViewPage, ShowsASceneAndItsInstancesInWindowsOfAnyWidthInBothThemes) {
  if (!has_three()) GTEST_SKIP() << "built without three.js";
  ASSERT_NO_FATAL_FAILURE(open_scene());
  for (const int width : {390, 1440}) {
    const auto report = used({width, width == 1440, true});
    ASSERT_NO_FATAL_FAILURE(expect_scene(report));
    EXPECT_EQ(report["drawn"], true);
    EXPECT_GT(report["byDrag"], 0.0);
    EXPECT_LE(report["scrollWidth"], width) << "the page scrolls sideways";
    EXPECT_EQ(report["colours"], Json({"surface", "side", "level", "instance"}));
  }
}

TEST_F(ViewPage, AnswersInASceneWithoutWebGl) {
  ASSERT_NO_FATAL_FAILURE(open_scene());
  const auto report = used({1440, false, false}, has_three());
  expect_scene(report);
  EXPECT_EQ(report["hasPicture"], false);
}

TEST_F(ViewPage, AnswersWithoutWebGl) {
  const auto report = used({1440, false, false}, has_three());
  expect_used(report);
  EXPECT_EQ(report["hasPicture"], false);
  EXPECT_NE(std::string(report["explanation"]).find(has_three() ? "WebGL" : "three.js"),
            std::string::npos);
}

TEST_F(ViewPage, AnswersWithoutThree) {
  const auto report = used({390, true, true}, false);
  expect_used(report);
  EXPECT_EQ(report["hasPicture"], false);
  EXPECT_NE(std::string(report["explanation"]).find("built without three.js"), std::string::npos);
}

TEST_F(ViewPage, ShowsARecordedSession) {
  ASSERT_EQ(run({"touch", "tree.ptree", "--seconds", "1", "--deterministic", "--trace", "s.trace"})
                .status,
            kDone);
  ASSERT_TRUE(model_->read_trace("s.trace"));
  const auto report = used({1440, true, false}, has_three());
  expect_used(report);
  EXPECT_EQ(report["timeline"], true);
}

}  // namespace
}  // namespace planetree::tools
