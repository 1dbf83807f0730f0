"""What each part of the evidence method buys: channels, rules and numbers changed one by one."""
