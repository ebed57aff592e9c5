#include "tools/view/page_activity.h"

#include <gtest/gtest.h>

#include "tests/tools/tune/made_accesses.h"

namespace planetree::tools {
namespace {

using Event = PageAccess::Event;

PageAccess needed(std::uint32_t page, Event event) {
  PageAccess access = lookup(0, page, event);
  access.needed = true;
  return access;
}

void add(PageActivity& activity, const PageAccess& access) { activity.add({&access, 1}); }

TEST(PageActivity, FollowsAPage) {
  PageActivity activity({0, 1, 1});
  EXPECT_EQ(activity.states()[1], PageState::kUnread);
  add(activity, needed(1, Event::kMissed));
  EXPECT_EQ(activity.states()[1], PageState::kWanted);
  add(activity, lookup(0, 1, Event::kInstalled));
  EXPECT_EQ(activity.states()[1], PageState::kResident);
  add(activity, lookup(0, 1, Event::kEvicted));
  EXPECT_EQ(activity.states()[1], PageState::kEvicted);
  EXPECT_EQ(activity.changes(), 3u);
  add(activity, lookup(0, 1, Event::kEvicted));
  EXPECT_EQ(activity.changes(), 3u);
}

TEST(PageActivity, DoesNotWantWhatIsHereOrChangesNothing) {
  PageActivity activity({0, 0, 0});
  add(activity, lookup(0, 0, Event::kMissed));
  EXPECT_EQ(activity.states()[0], PageState::kUnread) << "not needed";
  add(activity, lookup(0, 1, Event::kInstalled));
  add(activity, needed(1, Event::kMissed));
  EXPECT_EQ(activity.states()[1], PageState::kResident) << "its lookup was recorded late";
  add(activity, lookup(0, 2, Event::kEvicted));
  add(activity, lookup(0, 2, Event::kHit));
  EXPECT_EQ(activity.states()[2], PageState::kEvicted) << "its lookup was recorded late";
}

TEST(PageActivity, IgnoresPagesThatTheFileDoesNotHave) {
  PageActivity activity({0});
  add(activity, lookup(0, 7, Event::kInstalled));
  EXPECT_EQ(activity.changes(), 0u);
}

TEST(PageActivity, CountsByLevel) {
  PageActivity activity({0, 2, 2, 5});
  for (const std::uint32_t page : {0U, 2U, 3U}) add(activity, lookup(0, page, Event::kInstalled));
  add(activity, lookup(0, 3, Event::kEvicted));
  const auto levels = activity.count_levels(0, 3);
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[0][PageState::kResident], 1u);
  EXPECT_EQ(levels[1].all(), 0u);
  EXPECT_EQ(levels[2].all(), 2u);
  EXPECT_EQ(levels[2][PageState::kResident], 1u);
  EXPECT_EQ(activity.count(0, 4)[PageState::kEvicted], 1u);
}

}  // namespace
}  // namespace planetree::tools
