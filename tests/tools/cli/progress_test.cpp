#include "tools/cli/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

namespace planetree::tools {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

/// A Progress that writes to memory, with a clock that the test advances.
class Recorder {
 public:
  explicit Recorder(Progress::Style style)
      : stream_(open_memstream(&text_, &size_)),
        progress_(stream_, style, [this] { return now_; }) {}
  ~Recorder() {
    progress_.finish();
    std::fclose(stream_);
    std::free(text_);
  }

  Progress& progress() { return progress_; }
  void pass(nanoseconds time) { now_ += time; }
  std::string text() {
    std::fflush(stream_);
    return {text_, size_};
  }
  std::ptrdiff_t count(char c) {
    const std::string all = text();
    return std::count(all.begin(), all.end(), c);
  }

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* stream_;
  nanoseconds now_ = seconds(1000);
  Progress progress_;
};

TEST(Progress, IsSilentWhenQuiet) {
  Recorder recorder(Progress::Style::kSilent);
  recorder.progress().start("sorting", 100, "cells");
  for (int i = 0; i < 100; ++i) {
    recorder.pass(seconds(10));
    recorder.progress().add(1);
  }
  recorder.progress().finish();
  EXPECT_EQ(recorder.text(), "");
}

TEST(Progress, LeavesALastLineWherePeopleWatch) {
  for (const bool is_long : {false, true}) {
    for (const auto style : {Progress::Style::kSilent, Progress::Style::kLines,
                             Progress::Style::kBar, Progress::Style::kJson}) {
      Recorder recorder(style);
      recorder.progress().start("sorting", 2, "cells");
      recorder.pass(is_long ? seconds(10) : milliseconds(10));
      recorder.progress().add(2);
      recorder.progress().finish("2 cells sorted");
      const bool expected =
          style == Progress::Style::kBar || (style == Progress::Style::kLines && is_long);
      EXPECT_EQ(recorder.text().ends_with("2 cells sorted\n"), expected);
    }
  }
}

TEST(Progress, WritesALineEveryFiveSeconds) {
  Recorder recorder(Progress::Style::kLines);
  recorder.progress().start("sorting", 2000, "cells");
  for (int i = 0; i < 120; ++i) {
    recorder.pass(milliseconds(100));
    recorder.progress().add(10);
  }
  recorder.progress().finish();
  EXPECT_EQ(recorder.text(),
            "sorting   25%  100 cells/s  0:15 left\n"
            "sorting   50%  100 cells/s  0:10 left\n");
}

TEST(Progress, WritesNoLineForShortPhases) {
  Recorder recorder(Progress::Style::kLines);
  for (const char* phase : {"reading", "sorting", "writing"}) {
    recorder.progress().start(phase, 10, "cells");
    recorder.pass(seconds(2));
    recorder.progress().add(10);
  }
  recorder.progress().finish();
  EXPECT_EQ(recorder.text(), "writing  100%  5.0 cells/s  0:00 left\n");
}

TEST(Progress, RedrawsTheBarFiveTimesASecond) {
  Recorder recorder(Progress::Style::kBar);
  recorder.progress().start("sorting", 100'000, "cells");
  for (int i = 0; i < 1000; ++i) {
    recorder.progress().add(50);
    recorder.pass(milliseconds(1));
  }
  EXPECT_EQ(recorder.count('\r'), 5);
  EXPECT_EQ(recorder.count('\n'), 0);
}

TEST(Progress, BarFitsTheTerminal) {
  Recorder recorder(Progress::Style::kBar);
  recorder.progress().start("sorting", 1000, "cells");
  recorder.pass(seconds(1));
  recorder.progress().add(500);
  const std::string line = "sorting  [" + std::string(19, '#') + std::string(19, '.') +
                           "]   50%  500 cells/s  0:01 left";
  EXPECT_EQ(recorder.text(), "\r\033[K" + line);
  EXPECT_EQ(line.size(), 79U) << "where the width is unknown it is taken for 80";
}

TEST(Progress, ClearsTheBarOnceAtTheEnd) {
  Recorder recorder(Progress::Style::kBar);
  recorder.progress().start("sorting", 1000, "cells");
  recorder.progress().add(500);
  recorder.progress().finish();
  EXPECT_TRUE(recorder.text().ends_with("left\r\033[K"));
  const std::size_t size = recorder.text().size();
  recorder.progress().finish();
  EXPECT_EQ(recorder.text().size(), size);
}

TEST(Progress, TruncatesLongLines) {
  Recorder recorder(Progress::Style::kBar);
  recorder.progress().start(std::string(200, 'p'), 1000, "cells");
  recorder.progress().add(500);
  EXPECT_EQ(recorder.text(), "\r\033[K" + std::string(79, 'p'));
}

TEST(Progress, CountsWhereTheTotalIsUnknown) {
  Recorder recorder(Progress::Style::kLines);
  recorder.progress().start("reading", 0, "faces");
  recorder.pass(seconds(10));
  recorder.progress().add(123'456'789);
  EXPECT_EQ(recorder.text(), "reading  123,456,789 faces  12.3 M faces/s\n");
}

TEST(Progress, SurvivesMoreStepsThanItsTotal) {
  Recorder recorder(Progress::Style::kLines);
  recorder.progress().start("reading", 10, "faces");
  recorder.pass(seconds(10));
  recorder.progress().add(20);
  EXPECT_EQ(recorder.text(), "reading  100%  2.0 faces/s  0:00 left\n");
}

TEST(Progress, ShowsHoursAndAStall) {
  Recorder recorder(Progress::Style::kLines);
  recorder.progress().start("sorting", 100'000, "cells");
  recorder.pass(seconds(10));
  recorder.progress().add(0);
  EXPECT_EQ(recorder.text(), "sorting    0%  0.0 cells/s  ? left\n");
  recorder.pass(seconds(90));
  recorder.progress().add(1000);
  EXPECT_TRUE(recorder.text().ends_with("    1%  10 cells/s  2:45:00 left\n"));
}

TEST(Progress, WritesJsonEveryFiveSeconds) {
  Recorder recorder(Progress::Style::kJson);
  recorder.progress().start("matching \"edges\"", 2000, "parts");
  for (int i = 0; i < 120; ++i) {
    recorder.pass(milliseconds(100));
    recorder.progress().add(10);
  }
  recorder.progress().finish();
  EXPECT_EQ(recorder.text(),
            "{\"phase\":\"matching \\\"edges\\\"\",\"done\":500,\"total\":2000,\"unit\":\"parts\","
            "\"rate_per_second\":100.0,\"remaining_seconds\":15.0}\n"
            "{\"phase\":\"matching \\\"edges\\\"\",\"done\":1000,\"total\":2000,\"unit\":\"parts\","
            "\"rate_per_second\":100.0,\"remaining_seconds\":10.0}\n");
}

TEST(Progress, WritesUnknownNumbersAsNull) {
  Recorder recorder(Progress::Style::kJson);
  recorder.progress().start("reading", 0, "faces");
  recorder.pass(seconds(10));
  recorder.progress().add(50);
  recorder.progress().start("sorting", 100, "cells");
  recorder.pass(seconds(10));
  recorder.progress().add(0);
  EXPECT_EQ(recorder.text(),
            "{\"phase\":\"reading\",\"done\":50,\"total\":null,\"unit\":\"faces\","
            "\"rate_per_second\":5.0,\"remaining_seconds\":null}\n"
            "{\"phase\":\"sorting\",\"done\":0,\"total\":100,\"unit\":\"cells\","
            "\"rate_per_second\":0.0,\"remaining_seconds\":null}\n");
}

TEST(Progress, CountsStepsOfManyThreads) {
  Recorder recorder(Progress::Style::kLines);
  recorder.progress().start("sorting", 0, "cells");
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 10'000; ++i) recorder.progress().add(1);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(recorder.text(), "");
  recorder.pass(seconds(8));
  recorder.progress().add(0);
  EXPECT_EQ(recorder.text(), "sorting  40,000 cells  5.00 K cells/s\n");
}

}  // namespace
}  // namespace planetree::tools
