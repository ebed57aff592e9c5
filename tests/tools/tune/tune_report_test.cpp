#include "tools/tune/tune_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/tune/sample_tune_record.h"

namespace planetree::tools {
namespace {

TEST(TuneReport, HasTheKeysOfItsJson) {
  const TuneRecord record = sample_tune_record("a.trace");
  const auto json = nlohmann::json::parse(tune_json(record));
  EXPECT_EQ(json["references"], record.lookups);
  EXPECT_EQ(json["footprint_pages"], record.footprint);
  ASSERT_EQ(json["curves"].size(), 5u);
  EXPECT_EQ(json["curves"][0]["policy"], "clock");
  EXPECT_EQ(json["curves"][3]["policy"], "s3fifo");
  ASSERT_EQ(json["curves"][4]["points"].size(), record.curves.frames.size());
  EXPECT_EQ(json["curves"][4]["points"][2]["frames"], record.curves.frames[2]);
  EXPECT_EQ(json["curves"][4]["points"][2]["misses"], record.curves.policies[4].misses[2]);
  EXPECT_EQ(json["optimum"][1]["misses"], record.curves.optimum[1]);
  for (const char* key : {"accuracy", "coverage", "timeliness", "waste"})
    EXPECT_TRUE(json["prefetch"].contains(key)) << key;
  EXPECT_EQ(json["prefetch"]["accuracy"], 0.7);
  ASSERT_EQ(json["felt"].size(), record.felt.size());
  for (const char* key : {"memory_bytes", "degraded", "width_p99", "ticks_to_exact_p99"})
    EXPECT_TRUE(json["felt"][0].contains(key)) << key;
  EXPECT_EQ(json["recommended"]["memory_bytes"], record.recommended->memory_bytes);
  EXPECT_EQ(json["recommended"]["policy"], "clock");
  EXPECT_LT(json["recommended"]["low"], json["recommended"]["high"]);
}

TEST(TuneReport, NamesTheOptionsToSet) {
  TuneRecord record = sample_tune_record("a.trace");
  record.recommended->policy = EvictionPolicy::kS3Fifo;
  record.recommended->memory_bytes = 5'000'001;
  const std::string text = tune_words(record);
  EXPECT_NE(text.find("degraded < 0.500 %"), std::string::npos) << text;
  EXPECT_NE(text.find(".memory_budget_bytes = 5000192, .max_probes = 1, "
                      ".policy = EvictionPolicy::kS3Fifo"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("--memory 4883K --policy s3fifo"), std::string::npos) << text;
}

TEST(TuneReport, NamesTheKneeWithoutAGoalThatIsKept) {
  TuneRecord record = sample_tune_record("a.trace");
  const std::string knee =
      std::to_string((record.memory_for(record.curves.frames[record.knee]) + 1023) / 1024);
  record.recommended->is_kept = false;
  const std::string text = tune_words(record);
  EXPECT_NE(text.find("is not kept, even with all pages in memory"), std::string::npos) << text;
  EXPECT_NE(text.find("--memory " + knee + "K --policy clock"), std::string::npos) << text;
  record.recommended.reset();
  EXPECT_NE(tune_words(record).find("--memory " + knee + "K"), std::string::npos);
  record.model.clear();
  EXPECT_EQ(tune_words(record).find("--memory "), std::string::npos);
  EXPECT_NE(tune_words(record).find("name the model by --model"), std::string::npos);
  EXPECT_TRUE(nlohmann::json::parse(tune_json(record))["recommended"].is_null());
}

TEST(TuneReport, SaysWhatWasSampledAndLost) {
  TuneRecord record = sample_tune_record("a.trace");
  EXPECT_EQ(tune_words(record).find("dropped"), std::string::npos);
  EXPECT_EQ(tune_words(record).find("was replayed"), std::string::npos);
  record.lost = 12'345;
  record.curves.sampled_step = 8;
  record.curves.first_sampled = 5;
  record.curves.error = 0.0042;
  const std::string text = tune_words(record);
  EXPECT_NE(text.find("12,345 records were dropped"), std::string::npos);
  EXPECT_NE(text.find("one in 8 pages was replayed"), std::string::npos);
  EXPECT_NE(text.find("within 0.420 %"), std::string::npos);
}

}  // namespace
}  // namespace planetree::tools
