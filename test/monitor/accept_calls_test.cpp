#include "monitor/accept_calls.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>

#include "../await.h"
#include "../in_folder.h"
#include "../problem.h"
#include "../times.h"
#include "ros/verdict/kept_files.h"

namespace self_awareness {
namespace {

core::Suspect suspect(core::EventId id, const std::string& component, core::Kind kind,
                      bool abnormal = true) {
  core::Suspect suspect;
  suspect.id = id;
  suspect.component = component;
  suspect.abnormal = abnormal;
  suspect.reason.kind = kind;
  return suspect;
}

/// A request, or an entry of one.
template <typename Named = Accept::Request>
Named asked(const std::string& component, const std::string& topic = "",
            const std::string& kind = "") {
  Named request;
  request.component = component;
  request.topic = topic;
  request.kind = kind;
  return request;
}

Accept::Request back(const std::string& component, const std::string& topic = "") {
  Accept::Request request = asked(component, topic);
  request.undo = 1U;
  return request;
}

Accept::Request ofIncident(std::uint64_t id) {
  Accept::Request request;
  request.incident = id;
  return request;
}

// A robot of a fleet: its names are those of the model but for /r and a number.
class AcceptCallsTest : public InFolder {
 protected:
  AcceptCallsTest() { calls_.read(model_); }
  ~AcceptCallsTest() override { calls_.finish(); }

  /// @return the answer; `success` is what it has to be
  std::string call(const Accept::Request& request, bool success = true) {
    const Accept::Response response = calls_.serve(request, "/rqt");
    EXPECT_EQ(response.success != 0U, success) << response.message;
    return response.message;
  }
  std::string accepted() const { return inWordsOf(calls_.accepted().list()); }
  /// Accepts what stands, or what stood. @return the answer
  std::string acceptAlarm(bool success = true, std::uint64_t id = 5) {
    Accept::Request request;
    request.alarm = id;
    return call(request, success);
  }
  /// An alarm that stands from now on.
  core::Alarm& stands(core::Kind kind, std::vector<core::Suspect> suspects) {
    core::Alarm& alarm = alarm_.emplace();
    alarm.id = 5;
    alarm.kind = kind;
    alarm.culprit = suspects.empty() ? "" : suspects.front().component;
    alarm.suspects = std::move(suspects);
    return alarm;
  }

  static ros1::EncodingRules rules() {
    ros1::EncodingRules rules;
    rules.renames = {{"/r[0-9]+/(.*)", "/\\1"}};
    return rules;
  }

  const std::string model_ = path("robot.model");
  core::Vocabulary vocabulary_{{{"/driver", "/scan", "T"}, {"/base", "/odom", "T"}}};
  ros1::Encoder encoder_{rules(), nullptr};
  std::optional<core::Alarm> alarm_;
  self_awareness::Incidents incidents_;
  std::map<core::EventId, std::uint64_t> unknown_;
  int changes_ = 0;
  OperatorCalls admitted_;
  AcceptCalls calls_{admitted_,
                     {[this]() -> std::optional<Acceptable> {
                        return Acceptable{alarm_, incidents_, vocabulary_, unknown_, encoder_, 7};
                      },
                      [this](const std::string& /*caller*/) { ++changes_; }}};
};

TEST_F(AcceptCallsTest, WhatStandsIsTakenByItsIdWhileItStands) {
  stands(core::Kind::kSilent, {suspect(0, "/driver", core::Kind::kSilent),
                               suspect(1, "/base", core::Kind::kLate, false)});
  EXPECT_EQ(acceptAlarm(false, 4), "alarm: 4 does not stand any more");
  acceptAlarm();
  EXPECT_EQ(accepted(), "/driver on /scan (silent)") << "the other one is near its limit only";
  EXPECT_TRUE(calls_.covers(*alarm_, vocabulary_));
  alarm_.reset();
  EXPECT_EQ(acceptAlarm(false), "alarm: 5 does not stand any more");
  EXPECT_EQ(changes_, 1);
  call(back("/*"));
  stands(core::Kind::kSilent,
         {suspect(0, "/driver", core::Kind::kSilent), suspect(1, "/base", core::Kind::kLate)})
      .busy = core::Busy();
  acceptAlarm();
  EXPECT_EQ(accepted(), "/driver on /scan (silent)") << "the machine is busy: the culprit only";
  call(back("/*"));
  call(asked("/driver", "", "never came"));
  EXPECT_TRUE(calls_.covers(*alarm_, vocabulary_)) << "it is an absence";
  stands(core::Kind::kSlow, {suspect(0, "/driver", core::Kind::kSlow)});
  EXPECT_FALSE(calls_.covers(*alarm_, vocabulary_)) << "it is there";
}

TEST_F(AcceptCallsTest, ACallThatNamesNothingAcceptsNothingAndTellsWhatMayBeNamed) {
  EXPECT_EQ(call({}, false), "nothing stands, and nobody is new; name a component or a topic");
  stands(core::Kind::kSilent, {suspect(0, "/driver", core::Kind::kSilent)});
  unknown_[1] = 12;
  for (std::uint64_t id = 2; id < 6; ++id) {
    self_awareness::Incident& incident = incidents_.incidents.emplace_back();
    incident.id = incident.last = id;
    incident.kind = id == 2 ? "busy machine" : "silent";
    incident.component = id == 2 ? "" : id == 3 ? "/slam" : "/driver";
  }
  const std::string offers =
      "nothing is accepted, as nothing is named. Give \"{alarm: 5}\" for /driver on /scan "
      "(silent), "
      "\"{component: /base, topic: /odom, kind: stranger}\" for 12 messages of it";
  const std::string incident = "\"{incident: 4}\" for /driver (silent)";
  EXPECT_EQ(call({}, false),
            offers + ", " + incident + " and \"{incident: 3}\" for /slam (silent)");
  EXPECT_EQ(call(back(""), false), "nothing is accepted");
  call(asked("/slam"));
  EXPECT_EQ(call(back(""), false), "name what is to be judged again: /slam");
  EXPECT_EQ(call({}, false), offers + " and " + incident)
      << "what is accepted already is not offered";
  alarm_->culprit.clear();
  EXPECT_TRUE(
      has(call({}, false), "alarm 5: nobody is to blame for it (silent); name a component"));
  EXPECT_EQ(accepted(), "/slam");
  EXPECT_EQ(changes_, 1);
}

TEST_F(AcceptCallsTest, WhatIsNobodysFaultIsRefused) {
  for (const core::Kind kind :
       {core::Kind::kAllSilent, core::Kind::kNewMode, core::Kind::kBusyMachine}) {
    core::Alarm& alarm = stands(kind, {suspect(0, "/driver", core::Kind::kSilent),
                                       suspect(1, "/base", core::Kind::kSilent)});
    alarm.culprit.clear();
    const std::string answer = acceptAlarm(false);
    EXPECT_TRUE(has(answer, core::toString(kind)) && has(answer, "name a component")) << answer;
    call(asked("/driver", "", core::toString(kind)), false);
  }
  EXPECT_EQ(accepted(), "");
}

TEST_F(AcceptCallsTest, AModeIsTakenWhileItStandsOrByItsIncidentAndTakenBack) {
  const std::string words = "/base /camera /driver /imu (new mode)";
  core::Alarm& alarm = stands(core::Kind::kNewMode, {});
  alarm.silent.emplace();
  alarm.silent->others_go_on = true;
  alarm.silent->components = {"/base", "/camera", "/driver", "/imu"};
  EXPECT_FALSE(calls_.covers(alarm, vocabulary_));
  acceptAlarm();
  EXPECT_EQ(accepted(), words);
  EXPECT_TRUE(calls_.covers(alarm, vocabulary_));
  alarm.silent->components.push_back("/other");
  EXPECT_FALSE(calls_.covers(alarm, vocabulary_));
  alarm_.reset();
  ros1::CommunicationState state;
  calls_.tell(vocabulary_.types(), state);
  EXPECT_EQ(state.accepted, std::vector<std::string>{words + ", by /rqt"});
  EXPECT_EQ(state.accepted_of.at("/driver"), words);
  call(back("/camera"));
  EXPECT_EQ(accepted(), "");

  self_awareness::Incident incident;
  incident.id = 3;
  incident.kind = "new mode";
  incidents_.incidents = {incident};
  EXPECT_TRUE(has(call(ofIncident(3), false), "not all components that were off are known"));
  incidents_.incidents[0].together = {"/base", "/camera", "/driver", "/imu"};
  call(ofIncident(3));
  EXPECT_EQ(accepted(), words);
  calls_.finish();
  EXPECT_TRUE(ros1::readAccepted(ros1::pathOfAccepted(model_)).value().coversMode({"/imu"}));
  EXPECT_TRUE(has(call(asked("/driver", "", "new mode"), false), "accept it while it stands"));
  Accept::Request again = ofIncident(3);
  again.undo = 1U;
  call(again);
  EXPECT_EQ(accepted(), "");
}

TEST_F(AcceptCallsTest, OfConnectionsEachTopicIsTaken) {
  std::vector<core::Suspect> deaf{suspect(1, "/base", core::Kind::kUnsubscribed, false)};
  deaf[0].reason.topics = {"/cmd_vel", "/stop"};
  stands(core::Kind::kUnsubscribed, deaf);
  EXPECT_FALSE(has(acceptAlarm(), "nobody of that name")) << "/base is known";
  EXPECT_EQ(accepted(), "/base on /cmd_vel (not subscribed) and /base on /stop (not subscribed)");
  EXPECT_TRUE(calls_.covers(*alarm_, vocabulary_));
  call(back("/base", "/stop"));
  EXPECT_FALSE(calls_.covers(*alarm_, vocabulary_));
  ros1::CommunicationState state;
  calls_.tell(vocabulary_.types(), state);
  EXPECT_EQ(state.accepted_of.at("/base"), "/base on /cmd_vel (not subscribed)");
}

TEST_F(AcceptCallsTest, OfAnIncidentItsVictimsAreNotTaken) {
  self_awareness::Incident incident;
  incident.id = 3;
  incident.kind = "silent";
  incident.component = "/driver";
  incident.together = {"/base"};
  incident.victims = {"/slam"};
  incidents_.incidents = {incident};
  call(ofIncident(3));
  EXPECT_EQ(accepted(), "/driver (silent) and /base (silent)");
  call(back("/*"));
  incidents_.incidents[0].kind = "slow";
  call(ofIncident(3));
  EXPECT_EQ(accepted(), "/driver (slow)") << "who fell silent with it is not slow";
  incidents_.incidents[0].component.clear();
  incidents_.incidents[0].kind = "all silent";
  EXPECT_TRUE(has(call(ofIncident(3), false), "nobody is to blame"));
  EXPECT_TRUE(has(call(ofIncident(7), false), "there is none of the id 7"));
  Accept::Request both = ofIncident(3);
  both.component = "/a";
  EXPECT_TRUE(has(call(both, false), "alone, without component"));
}

TEST_F(AcceptCallsTest, SeveralAreTakenInOneCall) {
  Accept::Request request;
  using Entry = self_awareness::Acceptance;
  request.more = {asked<Entry>("/joystick", "/joy", "stranger"), asked<Entry>("nobody"),
                  asked<Entry>("/rqt", "/plot", "stranger")};
  const std::string answer = call(request, false);
  EXPECT_TRUE(begins(answer, "2 of 3: normal from now on: /joystick on /joy (stranger) and /rqt"));
  EXPECT_TRUE(has(answer, "refused: nobody: component: a name begins with a /"));
  EXPECT_EQ(accepted(), "/joystick on /joy (stranger) and /rqt on /plot (stranger)");
  EXPECT_EQ(changes_, 1);
}

TEST_F(AcceptCallsTest, ThereIsAMostInACallAndInAnAnswer) {
  Accept::Request request;
  for (std::size_t k = 0; k < core::Acceptances::kMost; ++k) {
    request.more.push_back(asked<self_awareness::Acceptance>("/n" + std::to_string(k)));
  }
  EXPECT_LT(call(request).size(), 2000U);
  EXPECT_TRUE(has(call(asked("/one_more"), false), "which is the most"));
  request.more.push_back(request.more[0]);
  EXPECT_TRUE(has(call(request, false), "more than 1000"));
}

TEST_F(AcceptCallsTest, NamesAreCheckedAndAreThoseOfTheModel) {
  for (const std::string& name :
       std::vector<std::string>{"driver", "*", "/dri*er", "/a\x1b", std::string(1001, '/')}) {
    call(asked(name), false);
    call(asked("", name), false);
  }
  EXPECT_TRUE(has(call(asked("", "", "slow"), false), "name a component or a topic"));
  EXPECT_TRUE(has(call(asked("/a", "", "odd"), false), "kind: odd is not a kind"));
  EXPECT_EQ(changes_, 0);
  const std::string answer = call(asked("/r7/driver_4242_1600000000000", "/r7/scan", "slow"));
  EXPECT_EQ(accepted(), "/driver on /scan (slow)");
  EXPECT_FALSE(has(answer, "known yet")) << answer;
  EXPECT_TRUE(has(call(asked("/nobody*")), "; nobody of that name is known yet: /nobody*"));
  EXPECT_FALSE(has(call(asked("/dri*")), "known yet"));
}

TEST_F(AcceptCallsTest, AllThatFitsIsTakenBackAndElseItIsSaidWhatIsAccepted) {
  call(asked("/driver", "/scan", "slow"));
  call(asked("/driver", "", "stale"));
  call(asked("/base"));
  EXPECT_TRUE(has(call(back("/slam"), false),
                  "/slam is not accepted; these are: /driver on /scan (slow), "));
  EXPECT_TRUE(
      begins(call(back("/driver")), "judged again: /driver on /scan (slow) and /driver (stale)"));
  EXPECT_EQ(accepted(), "/base");
  call(back("/base"));
  EXPECT_TRUE(has(call(back("/base"), false), "nothing is"));
}

TEST_F(AcceptCallsTest, AReloadDoesNotForgetWhatIsNotWrittenYet) {
  const std::string file = ros1::pathOfAccepted(model_);
  boost::filesystem::create_directory(file);  // so that it cannot be written
  call(asked("/driver", "", "slow"));
  ASSERT_TRUE(await([&] { return !calls_.error().empty(); }));
  calls_.read(model_);
  EXPECT_EQ(accepted(), "/driver (slow)");
  calls_.read(path("other.model"));
  EXPECT_EQ(accepted(), "") << "that of another model is another one";
  calls_.read(model_);
  EXPECT_EQ(accepted(), "/driver (slow)");
  boost::filesystem::remove(file);
  calls_.finish();
  calls_.read(model_);
  EXPECT_EQ(accepted(), "/driver (slow)") << "it is written";
}

TEST(OperatorCalls, ALoopIsAnsweredSometimes) {
  OperatorCalls calls;
  int answered = 0;
  const std::int64_t start = 1000 * kSecond;
  for (std::int64_t now = start; now < start + 60 * kSecond; now += kSecond / 100) {
    answered += calls.admit("clear", "/loop", now) ? 1 : 0;
  }
  EXPECT_GE(answered, OperatorCalls::kAtOnce + 5);
  EXPECT_LE(answered, OperatorCalls::kAtOnce + 6);
  EXPECT_TRUE(calls.admit("reload", "/operator", start)) << "another service";
}

}  // namespace
}  // namespace self_awareness
