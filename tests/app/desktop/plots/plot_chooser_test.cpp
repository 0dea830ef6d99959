#include "app/desktop/plots/plot_chooser.h"

#include <gtest/gtest.h>

namespace limpid {
namespace {

TEST(PlotChooser, FindsChannelsByAnyWordsOfTheirs) {
  const TraceChannels channels{RowLayout(3)};
  const auto found = [&](const std::string& words) {
    std::vector<std::string> keys;
    for (const ChannelInfo* channel : meant_by(words, channels)) keys.push_back(channel->key);
    return keys;
  };
  EXPECT_EQ(found("").size(), static_cast<std::size_t>(channels.count()));
  EXPECT_EQ(found("Device VELOCITY joint 2"),
            (std::vector<std::string>{"device/velocity.2", "device/measured_velocity.2"}));
  EXPECT_EQ(found("|f2|"), std::vector<std::string>{"proxy/contact_torque_norm"});
  EXPECT_EQ(found("x_e 3"), std::vector<std::string>{"coordination/error.3"});
  EXPECT_TRUE(found("velocity banana").empty());
  // Everyday words find channels, too.
  EXPECT_EQ(found("depth"), std::vector<std::string>{"coordination/gap"});
  EXPECT_EQ(found("penetration"), found("depth"));
  EXPECT_EQ(found("human torque |"), found("hand torque |"));
  EXPECT_FALSE(found("human torque |").empty());
  EXPECT_EQ(found("proxy tip").size(), 4u) << "where it is, and how fast it moves";
  // The best one comes first.
  EXPECT_EQ(found("").front(), "contact/total_force_norm");
  EXPECT_EQ(found("force").front(), "contact/total_force_norm");
  EXPECT_EQ(found("tip force").front(), "contact/total_force_norm");
  EXPECT_EQ(found("work").front(), "energy/controller_total");
  EXPECT_EQ(found("power").front(), "energy/controller_total");
  EXPECT_EQ(found("penetr").front(), "coordination/gap");
  EXPECT_EQ(found("torque").front(), "hand/torque_norm");
}

}  // namespace
}  // namespace limpid
