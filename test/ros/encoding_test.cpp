#include "self_awareness/ros/encoding.h"

#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/String.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "self_awareness/core/stream/mode.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/message_field.h"
#include "self_awareness/ros/stable_name.h"

namespace self_awareness::ros1 {
namespace {

template <typename Message>
std::vector<std::uint8_t> serialize(const Message& message) {
  std::vector<std::uint8_t> buffer(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(buffer.data(), static_cast<std::uint32_t>(buffer.size()));
  ros::serialization::serialize(stream, message);
  return buffer;
}

template <typename Message>
std::string readField(const Message& message, const std::string& path) {
  const std::vector<std::uint8_t> buffer = serialize(message);
  return MessageField(ros::message_traits::definition<Message>(),
                      ros::message_traits::datatype<Message>(), path)
      .read(buffer.data(), buffer.size());
}

template <typename Message>
std::string errorOf(const std::string& path) {
  try {
    MessageField(ros::message_traits::definition<Message>(),
                 ros::message_traits::datatype<Message>(), path);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

class EncoderTest : public testing::Test {
 protected:
  Encoder makeEncoder(const EncodingRules& rules) {
    return Encoder(rules,
                   [this](const core::EventType& type) { return vocabulary_.intern(type); });
  }
  static Connection scan() {
    Connection connection;
    connection.callerid = "/player";
    connection.topic = "/scan";
    connection.datatype = "sensor_msgs/LaserScan";
    return connection;
  }

  core::Vocabulary vocabulary_;
};

TEST(Connection, IsFilledFromItsHeader) {
  const Connection connection = connectionFrom({{"callerid", "/slam"},
                                                {"type", "nav_msgs/OccupancyGrid"},
                                                {"message_definition", "int8[] data"},
                                                {"latching", "1"},
                                                {"topic", "/as_the_publisher_calls_it"}},
                                               "/map");
  EXPECT_EQ(connection.callerid, "/slam");
  EXPECT_EQ(connection.topic, "/map");
  EXPECT_EQ(connection.datatype, "nav_msgs/OccupancyGrid");
  EXPECT_EQ(connection.definition, "int8[] data");
  EXPECT_TRUE(connection.latching);
}

TEST(Connection, ToleratesAHeaderThatLacksFields) {
  const Connection connection = connectionFrom({{"latching", "0"}}, "/map");
  EXPECT_EQ(connection.callerid, "");
  EXPECT_EQ(connection.datatype, "");
  EXPECT_FALSE(connection.latching);
}

TEST(Connection, NamesAreWhole) {
  for (const char* typed : {"/scan", "scan", "//scan", "/scan/"}) {
    const Connection connection = connectionFrom({{"callerid", typed}}, typed);
    EXPECT_EQ(connection.topic, "/scan") << typed;
    EXPECT_EQ(connection.callerid, "/scan") << typed;
  }
  EXPECT_EQ(connectionFrom({{"topic", "/robot//scan"}}, "scan").topic, "/robot/scan")
      << "recorded in a namespace";
  EXPECT_EQ(connectionFrom({{"topic", "/other"}}, "/scan").topic, "/scan");
}

TEST(ResolvedName, IsTheWholeOneAndStaysSo) {
  EXPECT_EQ(resolvedName("camera/depth//image/"), "/camera/depth/image");
  EXPECT_EQ(resolvedName("///ns///topic"), "/ns/topic");
  EXPECT_EQ(resolvedName("_x"), "/_x");
  EXPECT_EQ(resolvedName("//"), "/");
  for (const char* name : {"", "/", "/scan", "~scan", "(further topics)", "*"}) {
    EXPECT_EQ(resolvedName(name), name);
  }
}

TEST(StableName, IsWhole) {
  EXPECT_EQ(stableName("rostopic_10263_1795206536731"), "/rostopic");
  EXPECT_EQ(stableName("//ns/talker_4242_1430709709567"), "/ns/talker");
  EXPECT_EQ(stableName(""), "");
}

TEST(StableName, DropsTheNumbersOfAnonymousNodes) {
  EXPECT_EQ(stableName("/rostopic_10263_1795206536731"), "/rostopic");
  EXPECT_EQ(stableName("/record_1795206538727453261"), "/record");
  EXPECT_EQ(stableName("/ns/talker_4242_1430709709567"), "/ns/talker");
  EXPECT_EQ(stableName("/viewer_host_314_5876409862321874321"), "/viewer_host");
}

TEST(StableName, KeepsNumbersThatBelongToTheName) {
  for (const char* name : {"/camera_752112070204", "/laser_2", "/wheel_1_2", "/robot_20211104"}) {
    EXPECT_EQ(stableName(name), name);
  }
}

TEST(MessageField, ReadsAfterStringsArraysAndNestedMessages) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = "map";
  marker.ns = "people";
  marker.id = -7;
  marker.action = visualization_msgs::Marker::DELETE;
  marker.points.resize(3);
  marker.text = "Ada";
  marker.mesh_use_embedded_materials = 1;
  EXPECT_EQ(readField(marker, "action"), "2");
  EXPECT_EQ(readField(marker, "id"), "-7");
  EXPECT_EQ(readField(marker, "ns"), "people");
  EXPECT_EQ(readField(marker, "header.frame_id"), "map");
  EXPECT_EQ(readField(marker, "text"), "Ada");
  EXPECT_EQ(readField(marker, "mesh_use_embedded_materials"), "1");

  sensor_msgs::PointCloud2 cloud;
  cloud.fields.resize(2);  // an array of messages that hold a string
  cloud.fields[0].name = "x";
  cloud.fields[1].name = "intensity";
  cloud.point_step = 4000000000U;
  cloud.data.resize(17);
  cloud.is_dense = 1;
  EXPECT_EQ(readField(cloud, "point_step"), "4000000000");
  EXPECT_EQ(readField(cloud, "is_dense"), "1");

  rosgraph_msgs::Log log;
  log.level = rosgraph_msgs::Log::ERROR;
  log.name = std::string(200, 'n');
  EXPECT_EQ(readField(log, "level"), "8");
  EXPECT_EQ(readField(log, "name"), std::string(64, 'n'));
}

TEST(MessageField, SaysWhatIsWrongWithAField) {
  using visualization_msgs::Marker;
  EXPECT_EQ(errorOf<Marker>("verb"),
            "type field visualization_msgs/Marker: verb: has no field 'verb'");
  EXPECT_NE(errorOf<Marker>("pose").find("is a message itself"), std::string::npos);
  EXPECT_NE(errorOf<Marker>("points").find("is an array"), std::string::npos);
  EXPECT_NE(errorOf<Marker>("scale.x").find("is a float64"), std::string::npos);
  EXPECT_NE(errorOf<Marker>("pose.speed").find("in its geometry_msgs/Pose"), std::string::npos);
  EXPECT_NE(errorOf<sensor_msgs::JointState>("name").find("is an array"), std::string::npos);
}

TEST(MessageField, RefusesAMessageThatIsTooShort) {
  visualization_msgs::Marker marker;
  marker.ns = "people";
  const std::vector<std::uint8_t> buffer = serialize(marker);
  const MessageField field(ros::message_traits::definition(marker),
                           ros::message_traits::datatype(marker), "action");
  for (std::size_t size = 0; size < 34; ++size) {  // action ends after 12 + 4 + 4 + 4 + 6 + 4 + 4
    EXPECT_THROW(field.read(buffer.data(), size), std::out_of_range) << size;
  }
}

TEST_F(EncoderTest, AnEventIsSourceScopeAndType) {
  Connection connection = scan();
  connection.callerid = "/player_4242_1430709709567";
  auto encoder = makeEncoder(EncodingRules()).connect(connection);
  ASSERT_TRUE(encoder);
  EXPECT_EQ(vocabulary_.size(), 0U);  // a connection alone is no event
  EXPECT_FALSE(encoder->needsContent());
  const core::EventType expected{"/player", "/scan", "sensor_msgs/LaserScan"};
  EXPECT_EQ(vocabulary_.at(encoder->id()), expected);
}

TEST_F(EncoderTest, ATypeFieldTellsWhatAMessageDoes) {
  EncodingRules rules;
  rules.type_fields = {{"visualization_msgs/Marker", "action"}};
  visualization_msgs::Marker marker;
  Connection connection;
  connection.callerid = "/anchoring";
  connection.topic = "/people";
  connection.datatype = ros::message_traits::datatype(marker);
  connection.definition = ros::message_traits::definition(marker);
  auto encoder = makeEncoder(rules).connect(connection);
  ASSERT_TRUE(encoder && encoder->needsContent());
  const std::vector<std::uint8_t> add = serialize(marker);
  marker.action = visualization_msgs::Marker::DELETE;
  const std::vector<std::uint8_t> remove = serialize(marker);
  const core::EventId added = encoder->id(add.data(), add.size());
  const core::EventId removed = encoder->id(remove.data(), remove.size());
  EXPECT_EQ(vocabulary_.at(added).type, "visualization_msgs/Marker[action=0]");
  EXPECT_EQ(vocabulary_.at(removed).type, "visualization_msgs/Marker[action=2]");
  EXPECT_EQ(encoder->id(add.data(), add.size()), added);
}

Connection loads() {
  Connection connection;
  connection.callerid = "/arm";
  connection.topic = "/load";
  connection.datatype = "a/Load";
  connection.definition = "uint8 number\nfloat32 force\nint16 level\nstring text";
  return connection;
}

std::vector<std::uint8_t> loadOf(float force, std::int16_t level) {
  std::vector<std::uint8_t> bytes(1 + sizeof force + sizeof level + 4, 0);
  std::memcpy(bytes.data() + 1, &force, sizeof force);
  std::memcpy(bytes.data() + 1 + sizeof force, &level, sizeof level);
  return bytes;
}

EncodingRules rulesOfClasses(const std::string& field, std::vector<double> bounds) {
  EncodingRules rules;
  rules.type_fields = {{"a/Load", field}};
  rules.classes = {{"a/Load", {4, std::move(bounds)}}};
  return rules;
}

TEST_F(EncoderTest, ValuesArePutIntoClasses) {
  const auto typeOf = [&](const EncodingRules& rules, float force, std::int16_t level) {
    auto encoder = makeEncoder(rules).connect(loads());
    const std::vector<std::uint8_t> bytes = loadOf(force, level);
    return vocabulary_.at(encoder->id(bytes.data(), bytes.size())).type;
  };
  const EncodingRules force = rulesOfClasses("force", {-0.5, 0.25, 1e6});
  EXPECT_EQ(typeOf(force, -3, 0), "a/Load[force=below -0.5]");
  EXPECT_EQ(typeOf(force, -0.5F, 0), "a/Load[force=-0.5 to 0.25]");
  EXPECT_EQ(typeOf(force, 0.25F, 0), "a/Load[force=0.25 to 1e+06]");
  EXPECT_EQ(typeOf(force, INFINITY, 0), "a/Load[force=1e+06 or more]");
  EXPECT_EQ(typeOf(force, -INFINITY, 0), "a/Load[force=below -0.5]");
  EXPECT_EQ(typeOf(force, NAN, 0), "a/Load[force=NaN]");
  const EncodingRules level = rulesOfClasses("level", {7});
  EXPECT_EQ(typeOf(level, 0, 6), "a/Load[level=below 7]");
  EXPECT_EQ(typeOf(level, 0, 7), "a/Load[level=7 or more]");
}

TEST_F(EncoderTest, ClassesThatCannotBeAreNamed) {
  const auto why = [&](const EncodingRules& rules) -> std::string {
    try {
      rules.validate();
      makeEncoder(rules).connect(loads());
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(why(rulesOfClasses("force", {1, 2, 3})), "");
  EXPECT_NE(why(rulesOfClasses("force", {})).find("a/Load: force are not learned yet"),
            std::string::npos);
  EXPECT_NE(why(rulesOfClasses("text", {1})).find("only numbers have classes"), std::string::npos);
  for (const std::vector<double>& bounds :
       {std::vector<double>{1, 2, 3, 4}, {2, 1}, {1, 1}, {NAN}, {INFINITY}}) {
    EXPECT_NE(why(rulesOfClasses("force", bounds)).find("ascending bounds"), std::string::npos);
  }
  EncodingRules rules = rulesOfClasses("force", {1});
  rules.classes["a/Load"].number = 17;
  EXPECT_NE(why(rules).find("2 to 16, not 17"), std::string::npos);
  rules.type_fields.clear();
  EXPECT_NE(why(rules).find("a/Load"), std::string::npos);
}

EncodingRules rulesOfMode(const std::string& topic, const std::string& field) {
  EncodingRules rules = EncodingRules::defaults();
  rules.mode = ModeField{topic, field};
  return rules;
}

TEST_F(EncoderTest, AMessageOfTheModeIsAnEventAndTellsTheMode) {
  std_msgs::String message;
  Connection connection;
  connection.callerid = "/logic";
  connection.topic = "/r7/state";
  connection.datatype = ros::message_traits::datatype(message);
  connection.definition = ros::message_traits::definition(message);
  connection.latching = true;
  EncodingRules rules = rulesOfMode("/state", "data");
  rules.renames = {{"/r[0-9]+/(.*)", "/\\1"}};
  auto encoder = makeEncoder(rules).connect(connection);
  ASSERT_TRUE(encoder);
  EXPECT_TRUE(encoder->tellsMode());
  EXPECT_TRUE(encoder->needsContent());
  EXPECT_FALSE(encoder->accept()) << "what was latched is still no event but of the mode";
  message.data = "DRIVING";
  const std::vector<std::uint8_t> driving = serialize(message);
  message.data = "DOCKED";
  const std::vector<std::uint8_t> docked = serialize(message);
  const core::EventId drives = encoder->mode(driving.data(), driving.size());
  EXPECT_EQ(core::toString(vocabulary_.at(drives)),
            "/logic /state std_msgs/String[mode: DRIVING]");
  EXPECT_TRUE(vocabulary_.tellsMode(drives));
  EXPECT_NE(encoder->mode(docked.data(), docked.size()), drives);
  EXPECT_EQ(encoder->mode(driving.data(), driving.size()), drives);
  const core::EventId plain = encoder->id(driving.data(), driving.size());
  EXPECT_EQ(vocabulary_.at(plain).type, "std_msgs/String");
  EXPECT_EQ(encoder->id(docked.data(), docked.size()), plain);
  connection.topic = "/other";
  EXPECT_FALSE(makeEncoder(rules).connect(connection)->tellsMode());
}

TEST_F(EncoderTest, AFieldOfTheModeThatIsNotThereIsNamed) {
  Connection connection = scan();
  connection.definition = "string data";
  connection.datatype = "std_msgs/String";
  try {
    makeEncoder(rulesOfMode("/scan", "state")).connect(connection);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("the mode on /scan: "), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("std_msgs/String: state"), std::string::npos);
  }
}

TEST(EncodingRules, AModeThatCannotBeToldIsNamed) {
  const auto why = [](const EncodingRules& rules) -> std::string {
    try {
      rules.validate();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(why(rulesOfMode("/state", "data")), "");
  for (const char* topic : {"state", "", "/a b", "~state"}) {
    EXPECT_NE(why(rulesOfMode(topic, "data")).find("not the name of a topic"), std::string::npos)
        << topic;
  }
  EXPECT_NE(why(rulesOfMode("/state", "")).find("no field"), std::string::npos);
  EXPECT_NE(why(rulesOfMode("/clock", "clock")).find("exclude_topics"), std::string::npos);
  EncodingRules rules = rulesOfMode("/state", "data");
  rules.include_topics = {"/scan"};
  EXPECT_NE(why(rules).find("include_topics"), std::string::npos);
  rules.include_topics.emplace_back("/sta.*");
  EXPECT_EQ(why(rules), "");
}

TEST_F(EncoderTest, NobodyMakesUpAMode) {
  Connection connection = scan();
  connection.datatype = core::typeOfMode("a/B", "DRIVING");
  EXPECT_FALSE(makeEncoder(EncodingRules()).connect(connection));
  EXPECT_NE(whyLeftOut(connection).find("is no name of a type"), std::string::npos);
}

TEST(EventTypes, TooManyModesAreNamed) {
  core::Vocabulary vocabulary;
  for (std::size_t k = 0; k <= kMostTypesOfField; ++k) {
    vocabulary.intern({"/logic", "/state", core::typeOfMode("a/B", std::to_string(k))});
  }
  try {
    checkEventTypes(rulesOfMode("/state", "id"), vocabulary);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("/state: id"), std::string::npos);
  }
}

TEST_F(EncoderTest, SourcesMayBeLeftOut) {
  EncodingRules rules = EncodingRules::defaults();
  rules.source = EncodingRules::Source::kNone;
  Connection connection = scan();
  connection.callerid = "/play_1795206538727453261";  // it would be excluded
  auto encoder = makeEncoder(rules).connect(connection);
  ASSERT_TRUE(encoder);
  EXPECT_EQ(vocabulary_.at(encoder->id()).source, "");
  EXPECT_EQ(core::toString(vocabulary_.at(encoder->id())), "- /scan sensor_msgs/LaserScan");
  EXPECT_TRUE(makeEncoder(rules).includesSource("/play"));
  EXPECT_FALSE(makeEncoder(EncodingRules::defaults()).includesSource("/play"));
}

TEST_F(EncoderTest, NamesMayBeReplacedAndAllRulesSeeTheNewOnes) {
  EncodingRules rules;
  rules.renames = {{"/r[0-9]+/lidar", "/scan"}, {"/r[0-9]+/(.*)", "/\\1"}, {"/scan", "/never"}};
  rules.exclude_topics = {"/debug"};
  rules.exclude_sources = {"/tool"};
  const Encoder encoder = makeEncoder(rules);
  EXPECT_EQ(encoder.scopeOf("/r12/pose"), "/pose");
  EXPECT_EQ(encoder.scopeOf("/r12/lidar"), "/scan") << "by the first rule, and by no further one";
  EXPECT_EQ(encoder.scopeOf("/map/r12/pose"), "/map/r12/pose") << "must match the whole name";
  EXPECT_EQ(encoder.sourceOf("/r12/slam_4242_1600000000000"), "/slam");
  EXPECT_FALSE(encoder.includesTopic("/r3/debug"));
  EXPECT_FALSE(encoder.includesSource("/r3/tool"));
  EXPECT_FALSE(encoder.listens("/r3/tool"));
  for (const char* robot : {"/r1", "/r2"}) {
    Connection connection = scan();
    connection.callerid = robot + connection.callerid;
    connection.topic = robot + connection.topic;
    auto connected = encoder.connect(connection);
    ASSERT_TRUE(connected);
    EXPECT_EQ(core::toString(vocabulary_.at(connected->id())),
              "/player /scan sensor_msgs/LaserScan");
  }
  EXPECT_EQ(vocabulary_.size(), 1U);
}

TEST(Rename, AWholeNameIsReplacedWhateverTheShortestMatch) {
  EncodingRules rules;
  rules.renames = {{"/(r|r1)/scan|/r", "/\\1x"}};
  const Encoder encoder(rules, nullptr);
  EXPECT_EQ(encoder.scopeOf("/r1/scan"), "/r1x");
  EXPECT_EQ(encoder.scopeOf("/r"), "/x") << "a group that matches nothing is empty";
}

TEST(Rename, NamesAreTypedWithOrWithoutTheFirstSlash) {
  EncodingRules rules;
  rules.renames = {{"r[0-9]+/(.*)", "/\\1"}, {"(scan|odom)", "/all//\\1"}, {"(.*)", "/x/\\1"}};
  const Encoder encoder(rules, nullptr);
  EXPECT_EQ(encoder.scopeOf("/r7/cloud"), "/cloud");
  EXPECT_EQ(encoder.scopeOf("r7/cloud"), "/cloud");
  EXPECT_EQ(encoder.scopeOf("//odom"), "/all/odom");
  EXPECT_EQ(encoder.sourceOf("lidar"), "/x/lidar") << "the whole name is matched first";
}

TEST(Rename, WhatCannotBeDoneIsNamed) {
  const auto problem = [](const std::string& pattern, const std::string& name) {
    EncodingRules rules;
    rules.renames = {{pattern, name}};
    try {
      rules.validate();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto says = [&](const std::string& pattern, const std::string& name,
                        const std::string& text) {
    return problem(pattern, name).find(text) != std::string::npos;
  };
  EXPECT_EQ(problem("/r[0-9]+/(.*)", "/\\1"), "");
  EXPECT_TRUE(says("/r(", "/x", "'/r(' is not a regular expression"));
  EXPECT_TRUE(says("/r", "/\\1", "'/\\1' that takes the place of '/r' does not fit"));
  EXPECT_TRUE(says("/r/(.*)", "\\1", "must begin with a slash"));
  EXPECT_TRUE(says("/r", "/" + std::string(kLongestName, 'x'), "too long"));
}

TEST_F(EncoderTest, ToolsOfPeopleWhoWatchUseNoTopic) {
  const Encoder encoder = makeEncoder(EncodingRules::defaults());
  EXPECT_TRUE(encoder.listens("/slam"));
  EXPECT_TRUE(encoder.listens("/player")) << "is not /play";
  for (const char* tool : {"/record", "/recorder", "/rqt_graph", "/robot/rviz", "/rostopic"}) {
    EXPECT_FALSE(encoder.listens(tool)) << tool;
  }
}

TEST_F(EncoderTest, TheFirstMessageOfALatchingConnectionIsNoEvent) {
  Connection connection = scan();
  connection.latching = true;
  auto encoder = makeEncoder(EncodingRules()).connect(connection);
  EXPECT_FALSE(encoder->accept());
  EXPECT_TRUE(encoder->accept());
  connection.latching = false;
  EXPECT_TRUE(makeEncoder(EncodingRules()).connect(connection)->accept());
}

TEST_F(EncoderTest, TheOnlyMessageOfRostopicIsAnEvent) {
  Connection connection = scan();
  connection.latching = true;
  connection.callerid = "/ns/rostopic_10263_1795206536731";
  auto encoder = makeEncoder(EncodingRules::defaults()).connect(connection);
  ASSERT_TRUE(encoder);
  EXPECT_TRUE(encoder->accept());
  EXPECT_EQ(vocabulary_.at(encoder->id()).source, "/ns/rostopic");
  connection.callerid = "/not_rostopic";
  EXPECT_FALSE(makeEncoder(EncodingRules::defaults()).connect(connection)->accept());
}

TEST_F(EncoderTest, DefaultsLeaveOutOnlookersAndKeepTheRobot) {
  const Encoder encoder = makeEncoder(EncodingRules::defaults());
  Connection connection = scan();
  for (const char* node : {"/player", "/recorder_arm", "/replay_guard", "/base", "/ns/player",
                           "/rostopic_10263_1795206536731"}) {
    connection.callerid = node;
    EXPECT_TRUE(encoder.connect(connection)) << node;
  }
  for (const char* node : {"/play_1795206538727453261", "/record_1795206538727453261",
                           "/rqt_gui_py_node_17", "/rviz_1430709709567731649", "/self_awareness",
                           "/robot1/self_awareness_manager", "/ns/rviz"}) {
    connection.callerid = node;
    EXPECT_FALSE(encoder.connect(connection)) << node;
  }
  for (const char* topic : {"/clock", "/rosout_agg", "/statistics", "/self_awareness/status",
                            "/bond", "/robot_manager/bond"}) {
    EXPECT_FALSE(encoder.includesTopic(topic)) << topic;
  }
  for (const char* topic : {"/scan", "/rosout", "/diagnostics", "/alarm_clock", "/vagabond"}) {
    EXPECT_TRUE(encoder.includesTopic(topic)) << topic;
  }
}

TEST_F(EncoderTest, PatternsMatchWholeNames) {
  EncodingRules rules;
  rules.include_topics = {"/sc.*"};
  rules.exclude_sources = {"/play"};
  EXPECT_TRUE(makeEncoder(rules).connect(scan()));
  rules.include_topics = {"sc"};
  EXPECT_FALSE(makeEncoder(rules).connect(scan()));
  rules.include_topics = {};
  rules.include_sources = {"/slam"};
  EXPECT_FALSE(makeEncoder(rules).connect(scan()));
}

TEST_F(EncoderTest, PatternsAreTypedWithOrWithoutTheFirstSlash) {
  EncodingRules rules;
  rules.include_topics = {"scan|odom"};
  rules.exclude_sources = {"play"};
  const Encoder encoder = makeEncoder(rules);
  for (const char* topic : {"/scan", "scan", "//odom"}) {
    EXPECT_TRUE(encoder.includesTopic(topic)) << topic;
  }
  EXPECT_FALSE(encoder.includesTopic("/laser/scan"));
  EXPECT_FALSE(encoder.includesSource("/play"));
  EXPECT_TRUE(encoder.includesSource("/player"));
  EXPECT_FALSE(makeEncoder(EncodingRules::defaults()).includesTopic("clock"));
}

TEST_F(EncoderTest, NamesThePatternThatIsNoRegularExpression) {
  EncodingRules rules;
  rules.exclude_topics = {"/a(b"};
  try {
    makeEncoder(rules);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("'/a(b'"), std::string::npos) << error.what();
  }
}

TEST_F(EncoderTest, NoPatternAndNoNameTakesForever) {
  EncodingRules rules;
  rules.exclude_topics = {"(([a-z/_])*)*#", "(a*)*(a*)*(a*)*b", ".*.*.*.*.*.*x"};
  rules.exclude_sources = rules.exclude_topics;
  const Encoder encoder = makeEncoder(rules);
  Connection connection = scan();
  connection.topic = "/" + std::string(999, 'a');
  connection.callerid = connection.topic;
  EXPECT_TRUE(encoder.connect(connection));
  connection.callerid = "/" + std::string(30000, 'a');
  EXPECT_FALSE(encoder.connect(connection));
  stableName(connection.callerid + "_1");
}

TEST_F(EncoderTest, PatternsThatGrowAreRefused) {
  EncodingRules rules;
  std::string nested = "a";
  for (int level = 0; level < 20000; ++level) {
    nested = "(" + nested + ")";
  }
  for (const std::string& pattern : {std::string("(((a{1,100}){1,100}){1,100}){1,100}"), nested,
                                     std::string("\xFF\xFE["), std::string("(a)\\1")}) {
    rules.include_topics = {pattern};
    try {
      rules.validate();
      FAIL() << pattern.substr(0, 50);
    } catch (const std::invalid_argument& error) {
      EXPECT_LT(std::string(error.what()).size(), 500U);
    }
  }
  rules.include_topics.assign(100000, "/a[0-9]{5}");
  EXPECT_THROW(rules.validate(), std::invalid_argument);
}

TEST_F(EncoderTest, NewValuesWithoutEndTakeNoMemory) {
  EncodingRules rules;
  rules.type_fields = {{"test/Value", "value"}};
  const Encoder encoder(rules, [this](const core::EventType& type) {
    return internUpTo(kMostEventTypes, type, vocabulary_);
  });
  Connection connection = scan();
  connection.datatype = "test/Value";
  connection.definition = "uint32 value\n";
  auto encoded = encoder.connect(connection);
  ASSERT_TRUE(encoded);
  std::vector<std::uint8_t> message(4);
  for (std::uint32_t value = 0; value < 3 * kMostEventTypes; ++value) {
    std::memcpy(message.data(), &value, sizeof value);
    const core::EventId id = encoded->id(message.data(), message.size());
    EXPECT_EQ(id, std::min<std::size_t>(value, kMostEventTypes));
  }
  EXPECT_EQ(vocabulary_.size(), kMostEventTypes + 1);
  const std::uint32_t known = 3;
  std::memcpy(message.data(), &known, sizeof known);
  EXPECT_EQ(encoded->id(message.data(), message.size()), known) << "what was known stays";
  EXPECT_THROW(checkEventTypes({}, vocabulary_), std::invalid_argument);
}

}  // namespace
}  // namespace self_awareness::ros1
