"""Truth about a world, whatever the plant believes: where arms, mobiles and parts are, and what was done."""
