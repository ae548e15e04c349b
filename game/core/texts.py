"""Every English text of the game, by scene, ready for translation."""

from typing import Final

GAME: Final = "Tranquility"

# The window
SCREENSHOT_SAVED: Final = "Picture saved: {path}"
SCREENSHOT_FAILED: Final = "The picture could not be saved: {reason}"
NO_VIDEO_DEVICE: Final = "no video device"
NO_DISPLAY: Final = (
    "Tranquility needs a screen, and found none ({reason}).\n"
    "Start it from a desktop session. Training needs no screen: see `tranquility train --help`."
)

# After a fault
FAULT_TITLE: Final = "That screen has failed"
FAULT_KEPT: Final = "The game goes on, and your settings are safe."
FAULT_LOG: Final = "The details are in {path}"
FAULT_BACK: Final = "{key}  back to the menu"

# Keys' names and hints
ARROWS: Final = "↑ ↓"
ARROWS_ASIDE: Final = "← →"
HINT_MOVE: Final = "move"
HINT_CHOOSE: Final = "choose"
HINT_CHANGE: Final = "change"
HINT_BACK: Final = "back"
HINT_RESUME: Final = "resume"
HINT_FULL_SCREEN: Final = "full screen"
BACK: Final = "Back"
# What is written on a key, by pygame's name for it; a letter or a word that is not here is written as it is.
KEY_NAMES: Final = {
    "up": "↑",
    "down": "↓",
    "left": "←",
    "right": "→",
    "escape": "Esc",
    "return": "Enter",
    "kp_enter": "Num Enter",
    "pageup": "Page ↑",
    "pagedown": "Page ↓",
    "lshift": "Left Shift",
    "rshift": "Right Shift",
    "lctrl": "Left Ctrl",
    "rctrl": "Right Ctrl",
    "period": "Period",
    "comma": "Comma",
    "minus": "−",
    "plus": "+",
    "equals": "=",
    "slash": "/",
    "backslash": "\\",
    "semicolon": ";",
    "quote": "'",
    "backquote": "`",
    "leftbracket": "[",
    "rightbracket": "]",
    "kp_plus": "Num +",
    "kp_minus": "Num −",
    "kp_multiply": "Num ×",
    "kp_divide": "Num ÷",
    "kp_period": "Num .",
}

# The menu: word, and the line beside it while it is in focus
MENU_LINE: Final = "A moon lander, and a neural network that learns to fly it."
MENU: Final = {
    "play": ("Play", "Fly it yourself, and hand over whenever you like."),
    "missions": ("Missions", "A short campaign: wind, night, Mars, a moving pad. And the start of the day."),
    "watch": ("Watch", "See the network land, and what it thinks on the way down."),
    "train": ("Train", "Teach a network from nothing, and see it learn."),
    "digits": ("Draw a digit", "A network reads your handwriting, and shows how it knows."),
    "physics": ("Physics", "Stacks, slopes, impacts: the engine, to look into and take hold of."),
    "logbook": ("Logbook", "Your flights, to be watched again, raced, and flown on; and your skill."),
    "settings": ("Settings", "Screen, motion, colours, sound, keys."),
    "quit": ("Quit", "Back to Earth."),
}

# Settings: label, and the line under it
SETTINGS_TITLE: Final = "Settings"
SETTINGS: Final = {
    "full_screen": ("Full screen", "{key} or Alt + Enter at any time."),
    "reduced_motion": ("Reduced motion", "No shaking, no easing, a still sky."),
    "colour_safe": ("Colours for every eye", "Good and beyond limits, told apart without red and green."),
    "show_hints": ("Hints", "The keys while you fly, and a word of advice after a crash."),
}
SOUND_TITLE: Final = "SOUND"
SOUND_PROBLEM: Final = "Nothing is heard: no sound device was found."
SOUND_GROUPS: Final = {
    "effects": "Flight",
    "interface": "Clicks",
    "ambience": "Background",
    "altitude": "Altitude tone",
}
SOUND_SHARE: Final = "{percent} %"
SOUND_OFF: Final = "off"
SOUND_ALTITUDE: Final = "Height as notes: their pace is your speed, their side the pad's."
SWATCH_GOOD: Final = "within limits"
SWATCH_WARN: Final = "beyond limits"
KEYS_TITLE: Final = "CONTROLS"
KEYS_KEYBOARD: Final = "KEYBOARD"
KEYS_PAD: Final = "GAMEPAD"

# Pause
PAUSE_TITLE: Final = "Paused"
PAUSE_RESUME: Final = "Resume"
PAUSE_RETRY: Final = "Retry"
PAUSE_NEW_STARTS: Final = "New starts"
PAUSE_NETWORK: Final = "Network: {name}"
PAUSE_SETTINGS: Final = "Settings"
PAUSE_LEAVE: Final = "Leave"

# Read-outs of a flight
ALTITUDE: Final = "ALTITUDE"
DESCENT: Final = "DESCENT"
DRIFT: Final = "DRIFT"
TILT: Final = "TILT"
FUEL_USED: Final = "FUEL USED"
FUEL_LEFT: Final = "FUEL LEFT"
TIME_LEFT: Final = "TIME LEFT"
TIME_FLOWN: Final = "TIME"

# How a flight ended
OUTCOMES: Final = {
    "LANDED": ("Landed", "Both feet down, and at rest."),
    "CRASHED": ("Crashed", ""),
    "OUT_OF_BOUNDS": ("Lost", "Left the area {where}."),
    "TIMED_OUT": ("Out of time", "Time ran out: the limit is {limit} s."),
}
CAUSES: Final = {
    "NONE": "Broke up.",
    "HULL": "The hull struck the ground.",
    "TERRAIN": "Missed the pad: came down on the regolith.",
    "HARD": "Touched down at {value} m/s; {limit} is the limit.",
    "SLIDING": "Slid across the ground at {value} m/s; {limit} is the limit.",
    "TILTED": "Tilted {value}° at contact; {limit}° is the limit.",
}
# Where a flight left the area
LEFT_AT_THE_TOP: Final = "at the top, {height:.0f} m up"
LEFT_AT_THE_SIDE: Final = "at the side, {width:.0f} m from its middle"
# A word of advice on the card of a crash
ADVICE: Final = {
    "HULL": "Level out early; below four metres, steer in short taps.",
    "TERRAIN": "The amber dots end where you come down: push them onto the pad.",
    "HARD": "Brake early and evenly: keep the descent green below five metres.",
    "SLIDING": "Lean against the drift and fire, then level out before you touch.",
    "TILTED": "Counter a turn before it is finished: the craft goes on turning.",
}
TIME: Final = "TIME"
FUEL: Final = "FUEL"
TOUCHDOWN: Final = "TOUCHDOWN"
FROM_MIDDLE: Final = "OFF CENTRE"
SHARE_YOU: Final = "you {percent} %"
SHARE_NETWORK: Final = "network {percent} %"

# Play
YOU_FLY: Final = "You fly"
YOU_SHARE: Final = "You share the stick"
NETWORK_FLIES: Final = "The network flies"
FREE_FLIGHT: Final = "Free flight"
WITH_NETWORK: Final = "the {name} network can take over"
ALONE: Final = "on your own"
BEGIN: Final = "The moon waits for your first touch."
PATH_YOURS: Final = "where you drift, hands off"
PATH_NETWORK: Final = "where the network would fly"
NO_NETWORK: Final = "No network to hand over to: {problem}"
HINT_HAND_OVER: Final = "hand over"
HINT_TAKE_BACK: Final = "take back"
HINT_PAUSE: Final = "pause"
HINT_AGAIN: Final = "same start"
HINT_NEW: Final = "new start"
CARD_FIRST: Final = {True: "fly on", False: "try again"}

# Networks
NETWORK_YOURS: Final = "{name} (yours)"
NETWORK_ELSEWHERE: Final = (
    "made for something else than this lander: {features} inputs and {actions} actions, "
    "where it has {lander_features} and {lander_actions}"
)

# Watch
WATCH_TITLE: Final = "Watch"
WATCH_FLIES: Final = "The {name} network flies"
WATCH_SCRIPTED: Final = "The scripted pilot flies"
WATCH_ONE: Final = "one lander"
WATCH_MANY: Final = "{count} landers"
WATCH_LANDED: Final = "% landed"
WATCH_COUNTS: Final = "{landed} landed  ·  {lost} lost"
WATCH_MODEL: Final = "Flown by"
WATCH_ALL: Final = "all {count}"
WATCH_COUNT: Final = "Landers"
WATCH_SPEED: Final = "Speed"
WATCH_PROBLEM: Final = "{name} cannot fly: {problem}"
WATCH_STOPPED: Final = "Stopped"
HINT_STOP: Final = "stop"
HINT_GO: Final = "go on"
HINT_STEP: Final = "one step"
HINT_DECISION: Final = "one decision"
HINT_RESTART: Final = "new starts"
HINT_NEXT_LANDER: Final = "next lander"
MIND_TITLE: Final = "What the network thinks"
MIND_SCRIPTED_TITLE: Final = "What the pilot does"
MIND_SCRIPTED_FLOWN: Final = "flown"
# A decision of a network: what it expects, in points of reward, and why its action is flown, in two lines
Q_EXPECTED: Final = "expected score"
Q_ADVANTAGE: Final = "advantage"
Q_UNIT: Final = "points"
Q_BEST: Final = "best"
Q_BEST_FLOWN: Final = ("The best action is flown.", "")
Q_KEPT: Final = ("{kept} is kept: as good as the", "best ({best}) within {margin} points.")
Q_WEIGHS_NOTHING: Final = ("Written rules, no action values.", "")
VALUES_DAMAGED: Final = ("Its values are not numbers:", "this network is damaged.")
MIND_INPUTS: Final = "WHAT IT SENSES"
INPUTS: Final = (
    "across",
    "height",
    "drift",
    "climb",
    "lean, sin θ",
    "upright, cos θ",
    "turning",
    "left foot",
    "right foot",
)

# The gallery of physics
PHYSICS_TITLE: Final = "Physics"
# The word for an exhibit, the law it shows, and that law in figures.
# Title, law, and what is measured, by the state the exhibit is in
EXHIBITS: Final[dict[str, tuple[str, str, dict[str, str]]]] = {
    "stack": (
        "Stack",
        "The lowest contact carries all that stands on it. Throw the ball at a column, and see.",
        {
            "begun": "A column of {count:.0f} boxes of 1 kg weighs {weight:.1f} N.",
            "standing": "A column of {count:.0f} boxes of 1 kg weighs {weight:.1f} N; the ground pushes back under it "
            "with {push:.1f} N.",
            "fallen": "No column stands. {count:.0f} bodies weigh {weight:.1f} N; the ground pushes back with "
            "{push:.1f} N.",
        },
    ),
    "heap": (
        "Heap",
        "A hundred bodies fall, and every impact and every rub turns some of their energy into heat.",
        {
            "untouched": "Of {first:.0f} J of height and motion, {left:.0f} J are left.",
            "touched": "{first:.0f} J of height and motion at first, {left:.0f} J now: your hand has added or "
            "taken some.",
        },
    ),
    "slopes": (
        "Slopes",
        "A box slides where the slope is steeper than its friction holds: tan θ > μ.",
        {"": "tan {degrees:.0f}° = {tangent:.2f}; {slid:.0f} of 5 have slid by themselves."},
    ),
    "bounce": (
        "Bounce",
        "A ball comes back to e² of the height it fell from.",
        {
            "falling": "e = {restitution:.2f}: {restitution:.2f}² · {drop:.0f} m = {expected:.2f} m. "
            "That ball has not bounced yet.",
            "rising": "e = {restitution:.2f}: {restitution:.2f}² · {drop:.0f} m = {expected:.2f} m. "
            "That ball is on its way up, at {peak:.2f} m.",
            "measured": "e = {restitution:.2f}: {restitution:.2f}² · {drop:.0f} m = {expected:.2f} m. "
            "That ball came back to {peak:.2f} m.",
            "touched": "e = {restitution:.2f}: {restitution:.2f}² · {drop:.0f} m = {expected:.2f} m. "
            "Your hand moved that ball before it was measured.",
        },
    ),
    "impacts": (
        "Impacts",
        "Equal discs hand on their momentum whole: as many leave the row as have struck it.",
        {
            "untouched": "Nothing is lost when e = 1: {first:.1f} J at first, {now:.1f} J now.",
            "touched": "{first:.1f} J at first, {now:.1f} J now: your hand has added or taken some.",
        },
    ),
    "drag": (
        "Drag race",
        "Drag grows with speed until it carries the weight; from there on a fall is even.",
        {
            "falling": "Linear drag, 1 kg: m·g / c = {terminal:.2f} m/s. That disc falls at {speed:.2f} m/s.",
            "landed": "Linear drag, 1 kg: m·g / c = {terminal:.2f} m/s. That disc fell at {speed:.2f} m/s in the end.",
            "touched": "Linear drag, 1 kg: m·g / c = {terminal:.2f} m/s. Your hand moved that disc on its way down.",
        },
    ),
    "spin": (
        "Spin",
        "Free of gravity, what turns goes on turning; a push beside the middle both moves and turns.",
        {
            "": "A push of {impulse:.1f} N·s gives a bar J / m = {pace:.2f} m/s; {reach:.1f} m beside its middle, also "
            "r·J / I = {spin:.2f} rad/s.",
        },
    ),
}
SLOPE_LABEL: Final = "{tangent:.2f} {sign} {friction:.2f}"
SLOPE_FRICTION: Final = "μ = {friction:.2f}"
BOUNCE_COLUMN: Final = "e = {restitution:.2f}"
BOUNCE_MARK: Final = "{expected:.2f} m"
BOUNCE_PEAK: Final = "{expected:.2f} m, was {peak:.2f}"
DRAG_SPEED: Final = "{speed:.2f} m/s"
DRAG_LANES: Final = {
    "none": "no drag",
    "linear": "linear, {mass:.0f} kg → {terminal:.2f} m/s",
    "quadratic": "quadratic, {mass:.0f} kg → {terminal:.2f} m/s",
}
IMPACTS_RAIL: Final = "{sent} in motion at first  ·  {moving} now  ·  {momentum:.1f} kg·m/s"
SPIN_TURNING: Final = ("ω {spin:.2f} rad/s", "I·ω {momentum:.2f} kg·m²/s")  # one below the other
SPIN_BARS: Final = ("pushed in the middle: {motion}", "pushed near its end: {motion}")
SPIN_BARS_BEFORE: Final = ("to be pushed in the middle", "to be pushed near its end")
SPIN_MOTION: Final = "{pace:.2f} m/s, {spin:.2f} rad/s"
PHYSICS_GRAVITY: Final = "Gravity"
PHYSICS_GRAVITIES: Final = ("moon 1.62 m/s²", "Earth 9.81 m/s²")
PHYSICS_WEIGHTLESS: Final = "none"
PHYSICS_CONTACTS: Final = "Contacts"
PHYSICS_CONTACTS_WORDS: Final = ("hidden", "drawn")
PHYSICS_STOPPED: Final = "Stopped"
PHYSICS_DRAG: Final = "Take hold of anything that can move with the mouse."
PHYSICS_HAND: Final = "{key}: a hand to take hold of things"
BODIES: Final = "BODIES"
CONTACT_POINTS: Final = "CONTACTS"
KINETIC_ENERGY: Final = "IN MOTION"
STEP_TIME: Final = "ONE STEP"
HINT_NEXT_EXHIBIT: Final = "next"
HINT_CONTACTS: Final = "contacts"
HINT_RESTART_EXHIBIT: Final = "restart"

# The library of networks: what is wrong with a name, with a run, and what could not be done
NAME_EMPTY: Final = "A network needs a name."
NAME_LONG: Final = "A name has {most} letters at most."
NAME_LETTERS: Final = "A name may have only letters, digits, spaces and - _ ."
NAME_ENDS: Final = "A name must not begin or end with a dot or space."
NAME_DEVICE: Final = "Windows keeps the name {name} for itself."
NAME_TAKEN: Final = "There is a network called {name} already."
RUN_UNNAMED: Final = "run"
RUN_RESCUED: Final = "rescued run"
RUN_INCOMPLETE: Final = "{file} is missing"
RUN_LINK: Final = "a link that leads nowhere"
RUN_UNREADABLE: Final = "{file} is damaged"
RUN_ELSEWHERE: Final = "made for {env}, not for this lander"
LIBRARY_UNREADABLE: Final = "The networks in {folder} could not be read: {reason}"
GONE: Final = "{name} is not there any more."
NOT_DELETED: Final = "{name} could not be deleted: {reason}"
LIBRARY_NOT_PLAIN: Final = "{name} is not copied: {inside} in it is a link or not a plain file."
LIBRARY_TOO_LARGE: Final = "{name} is not copied: it is far larger than any network."
LIBRARY_NO_RUN: Final = "{name} is no folder with a network in it."
LIBRARY_NOT_RENAMED: Final = "{name} could not be renamed: {reason}"
LIBRARY_NOT_RESTORED: Final = "{name} could not be brought back: {reason}"
LIBRARY_NOT_EXPORTED: Final = "{name} could not be exported: {reason}"
LIBRARY_NOT_IMPORTED: Final = "{name} could not be copied here: {reason}"
LIBRARY_NOT_KEPT: Final = "{name} could not be kept: {reason}"

# Charts, the reward strip and the drawing of the network
CHART_LOG: Final = ("log", "scale")  # beside the axis, one below the other
CHART_SECONDS: Final = "{:.0f} s"
CHART_EMPTY: Final = "nothing to show yet"
NET_EMPTY: Final = "Units that light up, and weights that grow: once it learns."
STRIP_EMPTY: Final = "Each flight's earnings, part by part: once one has ended."
NET_ALL: Final = "{total} units"
NET_SOME: Final = "{shown} of {total}"
NET_UNIT: Final = "layer {layer}, unit {unit}"
NET_VALUE: Final = "value"
NET_POINTS: Final = "value, points"
NET_BIAS: Final = "bias"
NET_DAMAGED: Final = ": damaged"
# What blue edges and orange ones mean
NET_LEGEND: Final = {
    "weights": ("positive", "negative"),
    "activations": ("adds", "takes away"),
    "gradients": ("raised", "lowered"),
}
STRIP_LABEL: Final = "WHAT A FLIGHT IS PAID FOR"
# Parts of the reward: the word, and what it is
REWARD_PARTS: Final = {
    "distance": ("distance", "For coming nearer to the middle of the pad; going away costs as much."),
    "speed": ("speed", "For growing slower; growing faster costs as much."),
    "alignment": ("alignment", "For hanging upright above the pad; leaving that place costs as much."),
    "tilt": ("tilt", "Charged while leaning further than 34 degrees."),
    "feet": ("feet", "For each moment with both feet on the pad, half a second at most."),
    "engine": ("engine", "Charged for each moment an engine fires: fuel."),
    "switch": ("switching", "Charged for each engine that goes on or off: flicker."),
    "time": ("time", "Charged for each moment in the air: hovering must not pay."),
    "terminal": ("the end", "For a landing; a crash or leaving the area costs as much."),
}

# Flying against a ghost
DUEL: Final = "Side by side"
DUEL_RIVAL: Final = "against {name}"
DUEL_BEGIN: Final = "The ghost of {name} starts when you do."
HINT_LEAVE: Final = "leave"
RIVAL_RESULTS: Final = {
    "FLYING": "still flying",
    "LANDED": "landed",
    "CRASHED": "crashed",
    "OUT_OF_BOUNDS": "left the area",
    "TIMED_OUT": "ran out of time",
}
RIVAL_AFTER: Final = "landed {seconds} s after you"
RIVAL_BEFORE: Final = "landed {seconds} s before you"
RIVAL_TOGETHER: Final = "landed together with you"

# The knobs of a training run: fields of ai.agent.config.Config by name; one without a word here is called by its name
KNOBS: Final = {
    "learning_rate": "Learning rate",
    "final_learning_rate": "Learning rate, last",
    "discount": "Discount γ",
    "n_step": "n-step return",
    "batch_size": "Batch",
    "gradient_steps": "Steps per decision",
    "optimizer": "Optimizer",
    "cost": "Cost",
    "gradient_clip": "Gradient clip",
    "schedule_decisions": "Schedule",
    "hidden": "Hidden layers",
    "activation": "Activation",
    "layer_normalisation": "Normalise layers",
    "dueling": "Dueling",
    "normalise_inputs": "Normalise inputs",
    "output_scale": "Output scale",
    "replay_size": "Replay",
    "replay_prune": "Forget at once",
    "learning_starts": "Warm-up",
    "prioritised": "Prioritised",
    "priority_exponent": "Priority exponent",
    "importance_exponent": "Importance exponent",
    "mirror": "Mirror",
    "success_pass": "Success pass",
    "success_batch_size": "Success batch",
    "double": "Double",
    "target_update_interval": "Target sync every",
    "tau": "Target rate τ",
    "fly_target": "Fly the target",
    "epsilon_start": "ε at first",
    "epsilon_end": "ε at last",
    "epsilon_decay": "ε decay",
    "epsilon_decisions": "ε falls over",
    "epsilon_spread": "ε spread",
    "random_main": "Random main engine",
    "steadiness": "Steadiness",
    "num_envs": "Landers",
    "frame_skip": "Steps per choice",
    "spawn": "Spawns",
    "final_touchdown_limits": "Touchdown limits",
    "reward_scale": "Reward scale",
    "reward_weights": "Reward",
    "seed": "Seed",
    # and those of ai.digits.config.DigitConfig that have other names
    "epochs": "Epochs",
    "warm_up_epochs": "Warm-up",
    "label_smoothing": "Label smoothing",
    "ema_decay": "Averaging",
    "held_out": "Held out",
    "filters": "Filters",
    "convolutions": "Convolutions",
    "kernel": "Window",
    "output_activation": "Bent outputs",
    "dropout": "Dropout",
    "augmentation": "Augmentation",
    "unaugmented": "Left as they are",
}
KNOB_PAGES: Final = {
    "learning": "Learning",
    "network": "Network",
    "memory": "Memory",
    "target": "Target",
    "exploration": "Exploration",
    "lander": "Lander",
    "reward": "Reward",
}
KNOB_WORDS: Final = {
    "sgd": "plain",
    "mse": "squared",
    "softmax_cross_entropy": "entropy",
    "relu": "ReLU",
    "leaky_relu": "leaky",
}
KNOB_SWITCH: Final = ("off", "on")
# The parts of the reward: what each is called, and what it pays
KNOB_WEIGHTS: Final = {
    "distance": ("Distance", "Paid for each 0.1 m nearer to the middle of the pad; taken back on the way out."),
    "speed": ("Speed", "Paid for each 0.1 m/s slower; taken back for each faster."),
    "alignment": ("Alignment", "For being upright above the middle of the pad, falling to 0 at 3 m or 0.5 rad."),
    "tilt": ("Tilt", "For each physics step leaning more than 0.6 rad. Negative: it costs."),
    "feet": ("Feet", "For each physics step with both feet down, thirty at most."),
    "engine": ("Engine", "For each physics step with an engine on. Negative: fuel costs."),
    "switch": ("Switching", "For each engine that goes on or off at a decision. Negative: flickering costs."),
    "time": ("Time", "For each physics step. Negative: hovering must not pay."),
    "terminal": ("Terminal", "For a landing; as much is lost by a crash or by leaving the area."),
}
KNOB_SEED: Final = "What chance begins with: the same seed and the same knobs give the same network."
KNOB_NOW: Final = "now {value}"
KNOB_IDLE: Final = "no effect"
# Why a knob changes nothing any more, or never would, and which one does
KNOBS_IDLE: Final = {
    "learning_rate": "The schedule is over, so steps have the last learning rate: that is the knob to turn.",
    "schedule_decisions": "Nothing changes over it: neither the learning rate nor the touchdown limits.",
    "epsilon_start": "ε is the same at first and at last.",
    "epsilon_decay": "ε has come down to its last value: ε at last is the knob to turn.",
    "epsilon_decisions": "ε is at its last value from the start: ε at last is the knob to turn.",
    "epsilon_spread": "There is one lander: ε is its own.",
    "random_main": "Nothing is done at random: raise ε at last first.",
}
KNOBS_IDLE_WITHOUT: Final = "Changes nothing while {other} is {value}."
KNOBS_NEW_RUN: Final = "takes a new run"
KNOBS_BACK_TO: Final = "back to {value}"
KNOBS_CLICK: Final = "Click its name"
KNOBS_CHANGED: Final = "changed"
KNOBS_STARTS_ANEW: Final = "Starts anew"
KNOBS_STARTS_ANEW_AS: Final = "Starts anew as {name}"
KNOBS_MORE: Final = "{first} and {count} more"
KNOBS_APPLY: Final = "Apply"
KNOBS_UNDO: Final = "Undo"
KNOBS_PUT_ASIDE: Final = "Your knobs"
KNOBS_PUT_ASIDE_LINE: Final = "were put aside for {name}."
PRESETS: Final = {
    "modern": ("Modern", "The fastest learner we could build: within a minute, it lands."),
    "classic": (
        "Classic",
        (
            "Deep Q-learning as one first meets it: slow. Ours: clipped gradients, scaled rewards, a cost of time,"
            " four steps a decision, alignment as a potential."
        ),
    ),
}

# Whatever works in a process of its own
WORKER_RAISED: Final = "It stopped: {reason}."
WORKER_NOT_STARTED: Final = "It could not be started: {reason}."
WORKER_KILLED: Final = "Its process was killed ({signal}); perhaps the machine ran out of memory."
WORKER_SIGNAL: Final = "Its process was ended by {signal}."
WORKER_EXITED: Final = "Its process ended all of a sudden, with exit code {code}."
WORKER_SILENT: Final = "Its process has not answered for {seconds:.0f} s, and was ended."
WORKER_NONSENSE: Final = "Its process said something that makes no sense: {reason}."

# The sabotage lab: what is taken away, what to look out for, and what was measured (modern, seeds 0 and 1)
SABOTAGE: Final = "Sabotage…"
SABOTAGE_HEADING: Final = "Take one part away from {name}"
SABOTAGE_LEAVE: Final = "Back"
SABOTAGES: Final = {
    "no_target": (
        "No target",
        "No slower copy to aim at: the targets move with every step. Watch the loss, and mean Q.",
        "Hardly missed: both seeds landed 99% after 100,000 decisions, as early as with it.",
    ),
    "no_replay": (
        "No replay",
        "It learns from the newest memories alone, and may forget the rest. Watch the share that lands.",
        "It came later: 93% and more after 150,000 decisions with one seed, after 250,000 with the other.",
    ),
    "no_shaping": (
        "No shaping",
        "Only the end of a flight pays: nothing tells it that it comes closer. Watch for the first landing.",
        "It hovered, and landed nothing in 350,000 decisions. Then one seed reached 95%, the other 14%.",
    ),
    "no_exploration": (
        "No exploration",
        "Never a random action. Watch whether it finds the ground by itself.",
        "Luck: one seed landed 98% after 150,000 decisions, the other hovered for 300,000.",
    ),
    "rate_times_100": (
        "Rate ×100",
        "Every step goes a hundred times too far. Watch mean Q fall to what a crash costs.",
        "It never learned: 98% crashed after half a million decisions, and a whole layer was dead.",
    ),
    "no_n_step": (
        "1-step returns",
        "News of a landing travels back one decision at a time. Watch how late success comes.",
        "30% to 42% after 250,000 decisions, 76% to 98% after 500,000.",
    ),
    "one_lander": (
        "One lander",
        "The same learning, fed by one lander. Watch the number of decisions.",
        "8,000 decisions in 25 seconds, where 256 landers take 500,000; it landed once.",
    ),
    "uniform_actions": (
        "Uniform chance",
        "Random actions fire the main engine half the time: more than gravity. Watch them hover.",
        "Luck: one seed landed 99% after 100,000 decisions, the other hovered first and took 200,000.",
    ),
    "short_sight": (
        "Short sight",
        "With γ = 0.8, a landing one second away is worth 4% of itself. Watch the last metres.",
        "It never got there: 4% and 8% landed after half a million decisions, and most crashed.",
    ),
    "no_practice": (
        "No practice",
        "Every flight begins high up, none near the pad. Watch for the first landing.",
        "Luck: one seed landed 97% after 150,000 decisions, the other parked in the sky for 450,000.",
    ),
    "plain_steps": (
        "Plain steps",
        "Gradient steps as they are, in place of Adam's. Watch the share that lands.",
        "It falls and crashes: not one of 200 flights landed, even after half a million decisions.",
    ),
    "no_normalisation": (
        "Raw layers",
        "What goes into a layer may grow or shrink as it likes. Watch how steady success is.",
        "Later and shakier: 36% and 52% after 100,000 decisions, where modern has 98% and 80%.",
    ),
}

# Train: the scene
SWARM_BEST: Final = "best"
SWARM_LUCKIEST: Final = "luckiest"
TRAIN_TITLE: Final = "Watch it learn"
TRAIN_LINE: Final = "Press Start: what falls like stones learns to land."
TRAIN_BEGINS: Final = "The run is starting …"
TRAIN_FIGURES: Final = "Landers: {count}  ·  {seconds:.0f} s  ·  {decisions:,} decisions"
TRAIN_LANDED: Final = "% of the last 100 landed"
TRAIN_START: Final = "Start"
TRAIN_PAUSE: Final = "Pause"
TRAIN_RESUME: Final = "Go on"
TRAIN_STEP: Final = "Step"
TRAIN_SAVE: Final = "Save run"
TRAIN_PACES: Final = ("×1", "×4", "full")
TRAIN_RUNS: Final = "Your networks"
TRAIN_DUEL: Final = "Fly against it"
TRAIN_INSIDE: Final = ("The network, live", "What it is paid")
TRAIN_CHARTS: Final = {
    "success": "LANDED, %",
    "mean_return": "RETURN",
    "loss": "LOSS",
    "mean_q": "MEAN Q, POINTS",
    "epsilon": "EXPLORATION ε",
    "stage": "STAGE",
}
# What each will show, while it is empty
TRAIN_CHARTS_SHOW: Final = {
    "success": "of its last hundred flights",
    "mean_return": "what a flight earns it, on average",
    "loss": "how far off it is",
    "mean_q": "what it hopes to earn",
    "epsilon": "moves at random",
    "stage": "how high it starts",
}
TRAIN_THIS: Final = "this run"
TRAIN_RUN: Final = "{name} {number}"
TRAIN_MADE_ROOM: Final = "{name} is no longer beside it: there is room for {count}."
TRAIN_AXES: Final = ("by seconds", "by decisions", "each run whole")
TRAIN_AXIS: Final = ("{:.0f} s", "{:,.0f}", "{:.0f}%")
TRAIN_CHECKPOINT: Final = "checkpoint {seconds:.0f} s"
TRAIN_TURNED_MORE: Final = "{few} and {count} more"
TRAIN_NO_CHECKPOINT: Final = "There is nothing to fly against yet: press Start first."
TRAIN_KEPT: Final = "What it has learnt is kept, and offered when you come back."
TRAIN_NOTHING: Final = "There is nothing to save yet: press Start first."
TRAIN_NAME: Final = "{preset} run"
NAMING: Final = "Name this network"
TRAIN_SAVED: Final = "Saved as {name}: fly with it, or watch it."
TRAIN_NOT_SAVED: Final = "Not saved: {problem}"
NAMING_KEEP: Final = "Keep"
NAMING_LEAVE: Final = "Cancel"

# Your networks
RUNS_TITLE: Final = "Your networks"
RUNS_CHOOSE_TITLE: Final = "Choose a network"
RUNS_PLACE: Final = "Kept in {folder}. A run's folder that is dropped here is copied there."
RUNS_NONE: Final = "None of your own yet: train one, and keep it under a name."
RUNS_COLUMNS: Final = ("NAME", "LANDED", "DECISIONS", "SAVED")
RUNS_SHIPPED: Final = "with the game"
RUNS_NOTHING: Final = "There is no network here at all."
RUN_SETTINGS: Final = {0: "{preset}, as it is", 1: "{preset}, 1 setting changed"}
RUN_SETTINGS_MANY: Final = "{preset}, {count} settings changed"
RUN_SEED: Final = "{settings}  ·  seed {seed}"
RUN_SAVED: Final = "saved {when}"
RUN_SHIPPED: Final = "came with the game"
RUN_FIGURES: Final = ("LANDED", "DECISIONS", "LEARNT FOR")
RUN_FLIES: Final = "This one flies when you hand over."
RUN_SUGGESTION: Final = "{preset} {decisions} {percent}"
RUN_NAME: Final = "NAME"
RUN_CHOOSE: Final = "Take this one"
RUN_WATCH: Final = "Watch it"
RUN_FLY: Final = "Fly with it"
RUN_TRAIN: Final = "Go on training"
RUN_RENAME: Final = "Rename"
RUN_EXPORT: Final = "Export"
RUN_DELETE: Final = "Delete"
RUN_KEEP_NAME: Final = "Keep the name"
RUN_LEAVE_NAME: Final = "Leave it as it was"
HINT_KEEP_NAME: Final = "keep the name"
HINT_LEAVE_NAME: Final = "leave it as it was"
RUN_RESTORE: Final = "Bring back {name}"
RUN_RESTORED: Final = "{name} is back."
RUN_DELETED: Final = "{name} is gone, and can still be brought back."
RUN_EXPORTED: Final = "Copied to {path}"
RUN_IMPORTED: Final = "Copied here: {name}"
TRAIN_COMPARE: Final = "Compare"
TRAIN_COMPARE_WITH: Final = "Compare this run with which?"
TRAIN_NO_CURVES: Final = "{name} was saved without its curves."
PICKING_EMPTY: Final = "Nothing is saved yet."
HINT_TITLE: Final = "Hint"
HINT_APPLIED: Final = "Applied"
HINT_APPLY: Final = "Apply"
HINT_WENT_BACK: Final = "back to {decisions:,} decisions"
HINT_DISMISS: Final = "Dismiss"
HINT_UNDO: Final = "Undo"
# What a rule of ai.training.hints means, by its name
HINTS: Final = {
    "rate_too_high": "The learning rate is far too high: every step goes too far.",
    "damaged": "Steps that were far too long have ruined the network. Go back to before.",
    "loss_explodes": "The loss explodes: its steps are too long. Try a lower learning rate.",
    "q_runs_away": "Q has left what the rewards can pay: its guesses feed on each other.",
    "dead_units": "More than half of its units are silent for everything it sees.",
    "collapsed": "It flew better before. Go back to its best, with shorter steps.",
    "target_stands": "The target network hardly moves: it aims, and may fly, at what it knew long ago.",
    "short_sight": "Its discount γ is low: a landing that is a second away is worth little to it.",
    "no_guide": "Nothing it is paid says on the way whether it comes closer to the pad.",
    "crashes": "By now it should land, and nearly every flight still ends in a crash.",
    "hovers": "Time runs out: it hovers or parks beside the pad.",
    "small_memory": "Its memory holds only a few batches: it forgets what it has just learnt.",
    "overfed": "Few landers for so many learning steps: it sees the same again and again.",
    "random": "It still acts at random most of the time: ε is high.",
    "clipped": "Nearly every gradient is cut short: great errors count no more than small ones.",
    "plateau": "It has stopped getting better.",
}

# Train: the run that the last visit left without a name
TRAIN_LEFT: Final = "Your last run can go on where it stopped."
TRAIN_LEFT_FIGURES: Final = "Its best network landed {percent:.0f}% of its trials after {seconds:.0f} s of learning."
TRAIN_LEFT_YOUNG: Final = "It has learnt for {seconds:.0f} s."
TRAIN_LEFT_GO_ON: Final = "Go on with it"
TRAIN_LEFT_DISCARD: Final = "Discard it"

# Draw a digit
DIGITS_TITLE: Final = "Draw a digit"
DIGITS_NETWORKS: Final = {"modern": "Modern", "classic": "Classic"}
DIGITS_QUIZ: Final = "Quiz"
DIGITS_TRAIN: Final = "Train"
DIGITS_DREAM: Final = "Dream"
DIGITS_HINT_NETWORK: Final = "another network"
DIGITS_UNDO: Final = "Undo"
DIGITS_CLEAR: Final = "Clear"
DIGITS_EMPTY: Final = "Draw something"
DIGITS_EMPTY_HOW: Final = "With the mouse, a pen or a finger."
DIGITS_SURE: Final = "sure, {percent}"
DIGITS_LIKELY: Final = "probably, {percent}"
DIGITS_DISPUTED: Final = "disputed, {percent}"
DIGITS_UNSURE: Final = "not sure"
DIGITS_OR: Final = "or a {digit}, {percent}"
DIGITS_EITHER: Final = "a {digit}, {percent}, or a {other}, {other_percent}?"
DIGITS_TOO_LITTLE: Final = "Too little to tell."
DIGITS_SEES: Final = "WHAT IT SEES"
DIGITS_STAGES: Final = ("drawn", "cropped", "20 × 20", "pen", "centred")
DIGITS_WHY: Final = "WHY {digit} AND NOT {other}"
DIGITS_WHY_EMPTY: Final = "WHY"
DIGITS_WHY_LEGEND: Final = ("speaks for it", "against it")
DIGITS_FILTERS: Final = {False: "FIRST FILTERS", True: "FIRST WEIGHTS, THE BUSIEST"}  # as large as an image
DIGITS_FILTERS_LEGEND: Final = ("excite", "inhibit")
DIGITS_MAPS: Final = "LAYER {number}: {count} MAPS OF {height} × {width}"
DIGITS_UNITS: Final = "LAYER {number}: {count} VALUES"
DIGITS_READS: Final = "Of {count} test digits, drawn anywhere: "
DIGITS_READS_AS: Final = "{name} reads {percent}"
DIGITS_MEASURING: Final = "Measuring …"
DIGITS_NOT_MEASURED: Final = "Not measured: {problem}"
DIGITS_HINT: Final = "Switch a step off, and see what the networks then read of digits drawn anywhere."
DIGITS_FIX_HOW: Final = "Wrong? Tap the right digit."
DIGITS_FIXING: Final = "Learning that this is a {digit} …"
DIGITS_FIXING_NOW: Final = "{percent} now"
DIGITS_FIXED: Final = "A {digit} with {now} now, with {before} before."
DIGITS_FIX_COST: Final = "Test images it reads: {before:.2%} → {after:.2%}"
DIGITS_FIX_NEEDLESS: Final = "It is sure of a {digit} already."
DIGITS_NOT_FIXED: Final = "Not learnt"
DIGITS_UNDO_FIX: Final = "Undo the fix"
DIGITS_PROBLEM: Final = "{name} can't be read: {problem}"
DIGITS_ALL: Final = "all {count}"
DIGITS_PICK: Final = "Choose the network that reads"
SHELF_TESTED: Final = "reads {part:.2%} of the test images"
SHELF_DAMAGED: Final = "damaged"
SHELF_HELD_OUT: Final = "{part:.2%} of those held out"

# Fix it
FIX_NOT_KEPT: Final = "It could not be kept: {problem}"
FIX_NOT_UNDONE: Final = "It could not be undone: {problem}"

# Train: the network large, and knobs that were turned
TRAIN_CLOSER: Final = "Look closer"
TRAIN_CLOSER_BACK: Final = "Step back"
TRAIN_REVERTED: Final = "back to a checkpoint"
TRAIN_TEACH: Final = "Train on you"
TRAIN_NO_LESSONS: Final = "Land with 60 points or more, the end of it by hand: then it can learn from you."
TRAIN_TAUGHT: Final = "It learns from landings of yours as well: {count}."
TRAIN_TAUGHT_TICK: Final = "landings of yours: {count}"
TRAIN_TAUGHT_NAME: Final = "{preset} trained on you"
NET_TITLE: Final = "Inside the network"
NET_SHOWS: Final = ("weights", "activations", "gradients")
NET_LINES: Final = {
    "weights": "What it has learnt: blue lines push the next unit up, orange ones pull it down.",
    "activations": "What it thinks now, for what the best lander senses: how much each line adds or takes away.",
    "gradients": "What learning moves: light runs back from the error along the lines that change most.",
}

# Train a network to read digits: the scene
PUPIL_TITLE: Final = "Train it here"
PUPIL_LINE: Final = "Press Start: a network that has never seen a digit learns to read."
PUPIL_LOADING: Final = "Unpacking 60,000 handwritten digits …"
PUPIL_FIGURES: Final = "epoch {epoch:.2f} of {epochs}  ·  {seconds:.0f} s  ·  {rate:,.0f} images a second"
PUPIL_READ: Final = "% read of what was held out"
PUPIL_TESTED: Final = "% read of the 10,000 test images"
PUPIL_KEPT_BEST: Final = "Its best network, of epoch {epoch}, is kept. The last one read {last} of what was held out."
PUPIL_FALLEN: Final = "It read {best} before, and reads {now} now. Go back to its best?"
PUPIL_GO_BACK: Final = "Go back"
PUPIL_WENT_BACK: Final = "back to its best, {part:.1%}"
PUPIL_STOP: Final = "Stop"
PUPIL_STOPPING: Final = "Measuring …"
PUPIL_GO_ON: Final = "Go on with the last run"
PUPIL_DREAM: Final = "Let it dream"
PUPIL_QUIZ: Final = "Quiz it"
PUPIL_CHARTS: Final = {"loss": "LOSS", "accuracy": "READ RIGHT, %"}
PUPIL_CHARTS_SHOW: Final = {"loss": "how far off it is", "accuracy": "of digits it has never learnt from"}
PUPIL_HELD_OUT: Final = "held out"
PUPIL_BATCHES: Final = "as it learns"
PUPIL_SAVED: Final = "Saved as {name}. It can be chosen in Draw a digit."
PUPIL_NOTHING: Final = "There is no network yet: press Start, and let it learn for a while."
PUPIL_NAME: Final = "{preset} reader"
PUPIL_LEFT_FIGURES: Final = "It reads {part:.1%} after {seconds:.0f} s of learning. A new run takes its place."
PUPIL_LEFT_YOUNG: Final = "It has learnt for {seconds:.0f} s. A new run takes its place."
PUPIL_LEFT_KEEP: Final = "Keep it as {name}"
PUPIL_PRESETS: Final = {
    "modern": ("Modern", "Looks through small windows: slow to learn, and the best reader by far."),
    "classic": ("Classic", "Looks at all pixels at once: quick to learn, and good enough for neat hands."),
}
MATRIX_TITLE: Final = "WHAT IT MISREADS"
MATRIX_OF_BEST: Final = "·  its best, of epoch {epoch}"
MATRIX_AXES: Final = "rows: what it is  ·  columns: what it reads"
MATRIX_RIGHT: Final = "{digit}, read rightly"
MATRIX_WRONG: Final = "{digit}, read as {read}"
MATRIX_COUNT: Final = "{count} of {shown}  ·  {percent:.1f} %"
MATRIX_EMPTY: Final = "It fills as the network learns."

# A digit with its article
NUMERALS: Final = ("a 0", "a 1", "a 2", "a 3", "a 4", "a 5", "a 6", "a 7", "an 8", "a 9")

# Dream
DREAM_TITLE: Final = "Dream {numeral}"
DREAM_LINE: Final = "From nothing, ink flows to where it makes the network surer of {numeral}."
DREAM_READS: Final = "read as {numeral}, {percent}"
DREAM_ALL: Final = "ALL TEN"
DREAM_CALM: Final = "Calm"
DREAM_CALM_HELP: Final = (
    "Calm: soft, steady, and no more ink than a digit has. Wild, at 0: all that the network would fall for."
)
DREAM_START: Final = "Begin with"
DREAM_STARTS: Final = ("noise", "your drawing")
DREAM_AGAIN: Final = "Dream again"
DREAM_STEPS: Final = "{step} of {steps} steps"
HINT_DIGIT: Final = "another digit"

# Quiz
QUIZ_TITLE: Final = "Quiz"
QUIZ_LINE: Final = "It reads your hand, and you read strangers'. Who reads better?"
QUIZ_DRAW: Final = "Draw {digit}"
QUIZ_DRAW_HOW: Final = "Press Done, and the network says what it reads."
QUIZ_READ: Final = "What is this?"
QUIZ_READ_HOW: Final = "A stranger wrote it. Press the digit."
QUIZ_DONE: Final = "Done"
QUIZ_NEXT: Final = "Next"
QUIZ_AGAIN: Final = "Play again"
QUIZ_NOTHING: Final = "Draw something first."
QUIZ_NET_RIGHT: Final = "It reads {read}, {percent}: its point."
QUIZ_NET_WRONG: Final = "It reads {read}, {percent}: no point."
QUIZ_YOU_RIGHT: Final = "It was meant as {digit}: your point."
QUIZ_YOU_WRONG: Final = "It was meant as {digit}."
QUIZ_NET_TOO: Final = "The network reads {read}, {percent}."
QUIZ_ROUND: Final = "ROUND {number} OF {count}"
QUIZ_SIDES: Final = ("you", "network")
QUIZ_OF: Final = "of {count} read"
QUIZ_OVER: Final = {1: "You read better", 0: "Even", -1: "The network reads better"}
QUIZ_OVER_LINE: Final = "You read {you} of {asked} strangers' digits; it read {net} of your {drawn}."
QUIZ_NO_STRANGERS: Final = "No strangers' digits today: {problem}"

# The cockpit: how the stick is shared
DIAL_ENDS: Final = ("you", "network")
DIAL_ASSISTS: Final = {"tolerance": "network assists {percent} %", "guardian": "network guards {percent} %"}
DIAL_JOIN: Final = "  ·  "
DIAL_NEEDS: Final = "{name} can fly, but can't share the stick: it doesn't weigh actions."
CHECK_FLIGHT: Final = "Check flight"
CHECK_ALONE: Final = "without help: this one shows your own skill"
WITHOUT_HELP: Final = "without help"
FLOWN_ALONE: Final = "Nobody helps in this flight: it is yours alone."
OVERRIDE_ADDS: Final = "+ {engine}"
OVERRIDE_STOPS: Final = "− {engine}"
OVERRIDE_TURNS: Final = "{engine}, not {other}"
ENGINE_MAIN: Final = "main"
ENGINES_STEER: Final = ("", "left", "right")
# What became of the person's action, by ai.copilot.copilot.Rule: a title, and why, in two lines
INSIGHT_BELOW: Final = "{asked} is {loss} points below the best,"
INSIGHT_WHY: Final = {
    "PILOT": ("Yours is flown", INSIGHT_BELOW, "and {allowed} points are good enough."),
    "PILOT_MAIN": ("It steers for you", INSIGHT_BELOW, "more than {allowed}. Main is yours."),
    "PILOT_STEER": ("It sees to main", INSIGHT_BELOW, "more than {allowed}. You steer."),
    "COPILOT": ("It does this one", INSIGHT_BELOW, "more than {allowed}. Its neighbours are, too."),
    "HANDS_OFF": ("Hands off: it flies", "Touch anything, and you have", "the stick again."),
}
INSIGHT_ALONE: Final = "It flies alone"
INSIGHT_BEFORE: Final = "{title}, a moment ago"
INSIGHT_SAME: Final = "{asked} is the best action."
INSIGHT_SAME_GOOD: Final = "{asked} is as good as any."
INSIGHT_EVERY_PAD: Final = "more than {allowed}. For every pad: {flown}."
INSIGHT_ANOTHER: Final = "and right for another pad, perhaps yours."
INSIGHT_WORSE: Final = "{asked} is {loss} points below its {best},"
INSIGHT_MARGIN: Final = {True: "more than {allowed}.", False: "and it lets {allowed} points pass."}
INSIGHT_MEANT: Final = "WHICH PAD YOU SEEM TO MEAN"
PAD_NAMES: Final = {1: "wide  ×1", 3: "narrow  ×3", 5: "tiny  ×5"}
SHARE_MOMENTS: Final = "stepped in {times} ×"
SCORE: Final = "{points} points"
SCORE_BEST: Final = "{points} points, your best"
THREE_PADS: Final = "Three pads"
OTHER_HANDS: Final = "with {hands} hands"
TAUGHT: Final = "Kept as an example for a network to learn from."
NOT_TAUGHT: Final = "This landing could not be kept as an example: {reason}"

# Choices for the next flights
CHOICES_TITLE: Final = "Your flights"
CHOICES_HINT: Final = "choices"
PAUSE_CHOICES: Final = "Choices: help, pads, hands"
CHOICES_ASSIST: Final = "Network helps"
CHOICES_ASSIST_OFF: Final = "no"
CHOICES_ASSIST_HELP: Final = {
    False: "Nobody helps: let go of everything, and you fall. In flight: {less}, {more}, or the wheel.",
    True: "While you fly; let go of everything, and it flies. In flight: {less}, {more}, or the wheel.",
}
CHOICES_MODE: Final = "It steps in"
CHOICES_MODES: Final = ("when its choice is clearly better", "only in need")
CHOICES_MODES_HELP: Final = (
    "Tolerance: your action is flown if it is worth nearly as much as the best, or else the nearest that is.",
    "Guardian: your action is flown unless another is better by far, for every pad that you may mean.",
)
CHOICES_PADS: Final = "Pads"
CHOICES_PADS_WORDS: Final = ("one, on the plain", "three, among hills")
CHOICES_PADS_HELP: Final = (
    "One pad, six metres wide.",
    "Wide counts once, narrow three times, tiny five times. Choose in your head: nobody tells the co-pilot.",
)
CHOICES_HANDS: Final = "Hands"
CHOICES_HANDS_WORDS: Final = {"own": "yours", "laggy": "laggy", "noisy": "noisy", "sensor": "no main engine"}
CHOICES_HANDS_HELP: Final = {
    "own": "Your keys, as you press them.",
    "laggy": "Your keys arrive late: in 4 of 5 decisions the last action goes on. Let the network help.",
    "noisy": "One in seven engine commands and turns comes out wrong. Let the network help.",
    "sensor": "You steer, and have no main engine: without the network's help you fall.",
}
CHOICES_CHECK: Final = ("Check flights", "After four with help, one without, so that your own skill doesn't fade.")
CHOICES_TEACH: Final = ("Teach it", "Your good landings are kept on this computer, for a network to learn from.")
CHOICES_EXPLAIN: Final = ("Explain", "A panel says what the network thinks, and why it steps in.")
CHOICES_FLY: Final = "Fly"
CHOICES_LATER: Final = "Pads and hands change with the next flight."
SKILL_TITLE: Final = "YOUR OWN SKILL"
SKILL_FIGURE: Final = "landed, of the last {count} free ones that count"
SKILL_NONE: Final = "Free flights without any help are drawn here."
SKILL_BEST: Final = "best landing"
SKILL_TAUGHT: Final = "landings to learn from"

# Flights that are kept, and the logbook
FLIGHT_NOT_KEPT: Final = "The flight could not be kept: {reason}"
FLIGHT_DAMAGED: Final = "{name} is damaged: {problem}"
FLIGHT_TOO_LARGE: Final = "it is too large for a flight"
FLIGHT_FORMAT: Final = "it is no {format}, version {version}"
FLIGHT_START: Final = "no flight begins with seed {seed}, spawn {spawn} and {pads} pads"
FLIGHT_ACTIONS: Final = "what was done in each step makes no sense"
FLIGHT_LACKS: Final = "{name} is missing"
FLIGHTS_UNREADABLE: Final = "The logbook {path} could not be read: {reason}"
FLIGHTS_DAMAGED: Final = "{count} lines of {path} are damaged, and left as they are."
LOGBOOK_TITLE: Final = "Logbook"
LOGBOOK_PLACE: Final = "Kept in {folder}"
LOGBOOK_TOTALS: Final = ("FLIGHTS", "LANDINGS", "IN THE AIR", "FUEL", "LONGEST ROW")
LOGBOOK_FILTERS: Final = ("all flights", "landings", "the best")
LOGBOOK_COLUMNS: Final = ("WHEN", "WHERE", "END", "TIME", "POINTS", "FLOWN BY")
LOGBOOK_EMPTY: Final = "Nothing yet: every flight that ends is written down here."
LOGBOOK_SKILL: Final = "YOU LANDED, OF THE LAST 10 THAT COUNT"
LOGBOOK_FUEL: Final = "FUEL OF YOUR LANDINGS"
LOGBOOK_FLIGHT: Final = "flight {:.0f}"
LOGBOOK_YOU: Final = "you"
LOGBOOK_SHARED: Final = "both"
LOGBOOK_NETWORK: Final = "network"
LOGBOOK_UNCOUNTED: Final = "({points})"
LOGBOOK_WATCH: Final = "Watch it again"
LOGBOOK_RACE: Final = "Race its ghost"
LOGBOOK_THROW_AWAY: Final = "Throw it away"
LOGBOOK_BRING_BACK: Final = "Bring it back"
LOGBOOK_THROWN: Final = "The flight was thrown away, and can still be brought back; its line stays."
LOGBOOK_BROUGHT_BACK: Final = "The flight is back."
# Why a flight in the logbook can't be flown again
FLIGHT_THROWN: Final = "You threw it away."
FLIGHT_TOO_OLD: Final = "Too long ago: only the latest and the best can be flown again."
FLIGHT_NEVER_KEPT: Final = "It could not be kept when it was flown."
FLIGHT_MISSING: Final = "Its file is not there any more."
COURSE_FREE: Final = {1: "one pad", 3: "three pads"}

# Replay
REPLAY_TITLE: Final = "Replay"
REPLAY_MISSION: Final = "Replay: {mission}"
REPLAY_LINE: Final = "{end} after {seconds:.1f} s  ·  {when}"
REPLAY_LANES: Final = ("main", "left", "right")
REPLAY_TAKE_OVER: Final = "Fly on from here"
REPLAY_EXPORT: Final = "Save as film"
REPLAY_FROM_START: Final = "from the start"
REPLAY_HINT_TAKE: Final = "fly on"
REPLAY_OVER: Final = "This is the end: go back a little, and fly on from there."
REPLAY_OTHER_RULES: Final = "This flight was flown under other rules, and goes another way now."
YOU_FLEW: Final = "You flew"
BOTH_FLEW: Final = "You and the network flew"
NETWORK_FLEW: Final = "The network flew"
# Why a flight does not count as the player's own
NOT_COUNTED: Final = {
    "flown_on": "Not counted: it goes on from a replay.",
    "hands": "Not counted: not flown with your own hands.",
    "helped": "Not counted: flown with the network's help.",
    "handed_over": "Not counted: handed over to the network.",
    "practice": "Not counted: this is practice.",
    "outdated": "Not counted: this mission has other rules now.",
    "unknown": "Not counted: not flown by your own hands alone.",
}

# Courses: races, flying on, missions
RACE: Final = "Race"
RACE_RIVAL: Final = "the flight of {when}"
FLY_ON: Final = "Flying on"
FLY_ON_LINE: Final = "from {seconds:.1f} s on"
FLY_ON_BEGIN: Final = "It goes on with your first touch, and the ghost as it did."
CARD_FIRST_FIXED: Final = {True: "back", False: "try again"}
FLIGHT_MISSION: Final = "there is no mission called {name}"
MISSION: Final = "Mission"
MISSION_RIVAL: Final = "the network"
MEDALS: Final = ("no medal", "bronze", "silver", "gold")
DAILY: Final = "Start of the day"
DAILY_BEGIN: Final = "Everybody has this start today: three pads, and nobody to help."
# By name: what it is called, and what is asked
MISSIONS: Final = {
    "fall": ("Free fall", "Fall, and brake late: set it down on the pad below."),
    "brake": ("Braking", "High up and sinking fast: spend your height, not your fuel."),
    "aside": ("Sideways", "The pad is twelve metres away. Lean, drift, and lean back in time."),
    "wind": ("Wind", "It comes in gusts, mostly from the left: lean into it."),
    "tank": ("Low fuel", "Three seconds of main engine, and not a drop more."),
    "narrow": ("Narrow pad", "Half as wide, and higher than you think."),
    "mars": ("Mars", "Twice the gravity, twice the engine, and dust in the wind."),
    "earth": ("Earth", "Six times the gravity: be early in all you do. The legs take 3 m/s."),
    "night": ("Night", "Nothing shines but the pad, and your own fire."),
    "ferry": ("A moving pad", "The pad goes to and fro: touch down when you move as it does."),
    "outage": ("Engine failure", "No main engine from second 2 to 4. You have been told."),
}
MISSIONS_TITLE: Final = "Missions"
MISSIONS_LINE: Final = "Each teaches one thing, and another flies beside you. Gold: {gold} of {count}."
MISSIONS_COLUMNS: Final = ("MISSION", "MEDAL", "BEST FUEL")
MISSION_FLY: Final = "Fly it"
MISSION_LIMIT: Final = "{fuel:.1f} s of fuel and {seconds:.1f} s at most"
MISSION_ANY: Final = "any landing by your own hand"
MISSION_BEST: Final = "Your best: {fuel:.1f} s of fuel, {seconds:.1f} s, {points} points"
EXPORT_AS: Final = "Save this flight as a moving picture"
EXPORT_MORE: Final = "A GIF is small and shows anywhere; an MP4 is sharp, and the camera follows."
EXPORT_KINDS: Final = {".gif": "GIF", ".mp4": "MP4"}
EXPORT_GIF_ONLY: Final = (
    'A GIF is small and shows anywhere. To have MP4 as well, close the game and run: pip install -e ".[export]"'
)
EXPORT_CANCEL: Final = "Cancel"
EXPORT_GOES_ON: Final = "Cancel, {percent} %"
EXPORT_STOPPED: Final = "No moving picture was saved."
EXPORT_DONE: Final = "Saved: {path}"
EXPORT_FAILED: Final = "The moving picture could not be saved. {reason}"

# Keys and buttons
BINDINGS_TITLE: Final = "Keys and buttons"
BINDINGS_OPEN: Final = "Change keys and buttons"
BINDINGS: Final = {
    "MAIN": "Main engine",
    "LEFT": "Steer left",
    "RIGHT": "Steer right",
    "HANDOVER": "Hand over",
    "RETRY": "Retry",
    "PAUSE": "Pause",
    "CHOICES": "Choices",
    "SLOWER": "Less help, slower",
    "FASTER": "More help, faster",
    "MODE": "Way of helping",
    "STEP": "One step",
    "NEXT": "Next, new start",
    "PREVIOUS": "Previous",
    "FULLSCREEN": "Full screen",
    "SCREENSHOT": "Take a picture",
}
BINDINGS_PRESS_KEY: Final = "Press a key …"
BINDINGS_PRESS_BUTTON: Final = "Press a button …"
BINDINGS_NONE: Final = "–"
BINDINGS_NO_PAD: Final = "Plug in a gamepad first."
BINDINGS_FIXED: Final = "{key} keeps what it means in menus. Choose another."
BINDINGS_TAKEN: Final = "It was {other}, which now has {key}."
BINDINGS_ONLY: Final = "{key} is all that {other} has. Give that another first."
BINDINGS_RESET: Final = "{what} has its default again."
BINDINGS_ALL: Final = "Restore defaults"
BINDINGS_ALL_RESET: Final = "All defaults are restored."
HINT_AS_IT_WAS: Final = "default"
HINT_LEAVE_KEY: Final = "cancel"
MAIN_ENGINE: Final = "main engine"
TURN: Final = "turn"
TURN_TO_MOUSE: Final = "turn towards the pointer"
TURN_LEFT: Final = "turn left"
TURN_RIGHT: Final = "turn right"

# Gamepads that come and go
PAD_FOUND: Final = "Gamepad: {name}"
PAD_LOST: Final = "The gamepad was pulled out."

# Missions: medals, what flies beside one, and how the network does
AND: Final = " and "
MEDAL_NEXT: Final = "{medal} asks for {less}."
MEDAL_LESS_FUEL: Final = "{:.1f} s less fuel"
MEDAL_LESS_TIME: Final = "{:.1f} s less time"
MEDAL_GOLD: Final = "Both feet down, within gold's fuel and time."
MISSION_GOAL: Final = "Gold: {fuel:.1f} s of fuel, {seconds:.1f} s of time"
MISSION_RIVAL_LABEL: Final = "Beside you"
MISSION_GHOSTS: Final = {"recorded": "the recorded flight", "own": "your best"}
MISSION_RIVALS: Final = {"network": "network", "recorded": "recorded flight", "own": "your best"}
MISSION_NETWORK: Final = "The game's own network lands {landed} of 20 starts near this one."
MISSION_NETWORK_FAILS: Final = {
    "earth": "The game's own network lands {landed} of 20 starts near this one: in the others it leans too far.",
    "outage": "The game's own network lands none of 20 starts near this one: it can't know that its engine will fail.",
}

# A word of advice on the card of a mission that was lost
ADVICE_TANK: Final = "The tank was empty: fall longer, and brake once, late and hard."
ADVICE_OUTAGE: Final = "Rise while the engine works: what you gain is what you fall through later."
ADVICE_MOVING: Final = "Wait above the pad until you move as it does, and then go down."
ADVICE_WIND: Final = "Lean into the wind to stay where you are: it takes a few degrees."

# What surrounds a flight and can't be seen
GRAVITY: Final = "Gravity {gravity:.1f} m/s², {times:.1f} times the moon's"
WIND: Final = "Wind {push:.1f} m/s²"
PAD_LEFT: Final = "The pad goes left, {speed:.1f} m/s"
PAD_RIGHT: Final = "The pad goes right, {speed:.1f} m/s"
ENGINE_FAILS: Final = "The main engine fails in {seconds:.1f} s"
ENGINE_DEAD: Final = "No main engine for {seconds:.1f} s"
TANK_EMPTY: Final = "The tank is empty"
EDGE_ABOVE: Final = "The area ends {metres:.0f} m above"
EDGE_LEFT: Final = "The area ends {metres:.0f} m to the left"
EDGE_RIGHT: Final = "The area ends {metres:.0f} m to the right"

# The first flight. For each step: what to do, and what to say after several crashes where that is something else.
TUTORIAL_TITLE: Final = "First flight"
TUTORIAL_STEP: Final = "{number} of {count}"
TUTORIAL: Final = {
    "fire": ("{main}  fires the main engine. Hold it a moment.", ""),
    "fall": ("Let go of everything, and feel the moon pull.", ""),
    "lean": ("{turn}  turns the craft. A short tap is enough.", ""),
    "upright": (
        "{other}  turns it back. Stop it upright.",
        "{other}  in short taps, until it stands still and upright.",
    ),
    "brake": ("{main}  in bursts: sink slower than 1 m/s.", "{main}  long enough to slow down, then in short bursts."),
    "hand_over": ("{hand_over}  hands over: watch the network fly.", ""),
    "take_back": ("{hand_over}  again, and the stick is yours.", ""),
    "land": ("Now land: upright, on the pad, slower than 2 m/s.", "Land: {main}  in short bursts, all the way down."),
}
TUTORIAL_EITHER: Final = "{left} or {right}"
TUTORIAL_GOOD: Final = {
    "fire": "It pushes where the craft points",
    "fall": "Slowly at first, and then faster",
    "lean": "It leans, and drifts that way once it fires",
    "upright": "Upright",
    "brake": "That is how to come down",
    "hand_over": "It flies by itself now",
    "take_back": "Yours again",
    "land": "Landed",
}
# The turns of a mouse, whose one button turns the craft towards the pointer, and of a stick
TUTORIAL_POINT: Final = ("{key} with the pointer left of it", "{key} with the pointer right of it")
TUTORIAL_POINT_EITHER: Final = "{key} with the pointer beside it"
TUTORIAL_PUSH: Final = ("{key} to the left", "{key} to the right")
TUTORIAL_STANDS: Final = "Let go: it comes to stand upright."
TUTORIAL_READY: Final = "{main}  when you are ready. Then land: upright, slower than 2 m/s."
TUTORIAL_LET_GO: Final = "Let go of everything first."
# Why a lesson begins again, where a flight's own end does not say so
TUTORIAL_AGAIN: Final = "Once more, from the top."
TUTORIAL_NETWORK_LANDED: Final = "The network has landed it: now you."
TUTORIAL_LANDED_EARLY: Final = "Landed too early: more lessons come first."
TUTORIAL_TOO_HIGH: Final = "Let go of  {main} : the area ends above you."
TUTORIAL_RISES: Final = "Let go of  {main} : you are rising."
TUTORIAL_TOO_FAST: Final = "{main}  now: too fast, so near the ground."
TUTORIAL_TOO_TILTED: Final = "{other}  to stand upright before you touch."
TUTORIAL_AWAY: Final = "The pad is far: lean towards it with  {inward} , and fire."
TUTORIAL_DONE: Final = "You can fly"
TUTORIAL_DONE_REASON: Final = "That was all there is to it. The rest is practice."
TUTORIAL_OPEN: Final = "Fly the first flight again"
TUTORIAL_SKIP: Final = "skip this"
TUTORIAL_LEAVE: Final = "Leave out the first flight"
TUTORIAL_FLOWN: Final = "flown"
TUTORIAL_ASKS: Final = "Learn to fly, one thing at a time. Leave it whenever you like."

# Said on the spot, in the moment in which it happens
CONTACT_LIGHT: Final = "Contact light"

# Difficulty
FLIGHT_GRAVITY: Final = "its gravity makes no sense"
CHOICES_GRAVITY: Final = "Gravity"
CHOICES_GRAVITY_HELP: Final = "At once, and in free flights. Other than 100 % is practice: it is not among your best."
PACE: Final = "Speed of time"
CHOICES_PACE_HELP: Final = (
    "How fast time passes while you fly. Other than 100 % is practice: it is not among your best."
)
PRACTICE: Final = "practice"
PRACTICE_GRAVITY: Final = "gravity {percent} %"
PRACTICE_PACE: Final = "speed {percent} %"

# Size of text, by the setting's words
TEXT_SIZE: Final = "Text"
TEXT_SIZES: Final = {"normal": "normal", "large": "large", "largest": "largest"}

# What keys and pads point with, where others have a mouse
POINTER: Final = "Point"
POINTER_LEAVE: Final = "put it away"
POINTER_GRIP: Final = "hold to grip"
PEN_HOLD: Final = "hold to draw"
PEN_LEAVE: Final = "put the pen away"

# The command line
CLI_PHYSICS: Final = "open the gallery of physics"
CLI_EXHIBIT: Final = "what to begin with (default: {name})"
NETWORK_MISSING: Final = "{path} is missing"

# The settings file
SETTINGS_UNREADABLE: Final = "The settings could not be read: {reason}. Here are the defaults; the file becomes {name}."
SETTINGS_NOT_SAVED: Final = "The settings could not be saved: {reason}."
SETTINGS_DAMAGED: Final = "The settings file was damaged and is kept as {name}. These are the defaults."
SETTINGS_DAMAGED_HERE: Final = "The settings file is damaged. These are the defaults."
