"""Every command of the window: what it is called, its keys, where it belongs. Keys stand here and nowhere else.

What is listed are the keys that a command comes with; a person may give it others (``assign``).
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Command:
    """One thing that can be asked for by a key or a menu.

    id : name of the handler. text : what a person reads. keys : shortcuts, the first is shown.
    group : heading in the sheet of keys and in the menu.
    """

    id: str
    text: str
    keys: tuple[str, ...] = ()
    group: str = "Project"


COMMANDS = (
    Command("new", "New project", ("Ctrl+N",)),
    Command("open", "Open…", ("Ctrl+O",)),
    Command("sample", "Open the sample"),
    Command("sample_performance", "Open the sample performance"),
    Command("save", "Save", ("Ctrl+S",)),
    Command("save_as", "Save as…", ("Ctrl+Shift+S",)),
    Command("save_as_whole", "Save as, with its media…"),
    Command("collect", "Copy media into the project"),
    Command("add_clip", "Add a video…"),
    Command("add_character", "Add a character…"),
    Command("add_sequence", "Add a sequence of meshes…"),
    Command("export", "Export…", ("Ctrl+E",)),
    Command("render", "Render film…", ("Ctrl+R",)),
    Command("undo", "Undo", ("Ctrl+Z",), "Edit"),
    Command("redo", "Redo", ("Ctrl+Shift+Z", "Ctrl+Y"), "Edit"),
    Command("delete", "Delete what is selected", ("Del",), "Edit"),
    Command("clear_masks", "Remove all masks", (), "Edit"),
    Command("cancel", "Cancel the tool or the running work", ("Esc",), "Edit"),
    Command("propagate", "Run what is missing", ("Ctrl+Return",), "Edit"),
    Command("nudge_left", "Move the selected point left, the key motion earlier", ("Ctrl+Left",), "Edit"),
    Command("nudge_right", "Move the selected point right, the key motion later", ("Ctrl+Right",), "Edit"),
    Command("nudge_up", "Move the selected point up, play the key motion once more", ("Ctrl+Up",), "Edit"),
    Command("nudge_down", "Move the selected point down, play the key motion once less", ("Ctrl+Down",), "Edit"),
    Command("nudge_left_far", "The same, ten times as far left", ("Ctrl+Shift+Left",), "Edit"),
    Command("nudge_right_far", "Ten times as far right", ("Ctrl+Shift+Right",), "Edit"),
    Command("nudge_up_far", "Ten times as far up", ("Ctrl+Shift+Up",), "Edit"),
    Command("nudge_down_far", "Ten times as far down", ("Ctrl+Shift+Down",), "Edit"),
    Command("copy_pose", "Copy the pose edit of this frame", ("Ctrl+C",), "Edit"),
    Command("paste_pose", "Paste it into this frame", ("Ctrl+V",), "Edit"),
    Command("delete_vertex", "Delete the control vertex in all frames", ("Shift+Del",), "Edit"),
    Command("contact_here", "Contact of the selected point in this frame, or not", ("Shift+C",), "Edit"),
    Command("propose_contacts", "Propose contacts", ("Ctrl+Shift+C",), "Edit"),
    Command("accept_contacts", "Accept proposed contacts", ("Shift+Return",), "Edit"),
    Command("snap_contact", "Put the selected point's contact onto the measured surface", ("S",), "Edit"),
    Command("measure_background", "Measure the background", (), "Edit"),
    Command("end_point", "End the selected point here", ("E",), "Edit"),
    Command(
        "hide_point",
        "Hide the selected point here, or not; Motion graph: forbid",
        ("X",),
        "Edit",
    ),
    Command("draw_point", "Draw the selected point, or not", ("Shift+H",), "Edit"),
    Command("rename_point", "Rename the selected point", ("F4",), "Edit"),
    Command("play", "Play or pause", ("Space",), "Time"),
    Command("backward", "Play backwards", ("J",), "Time"),
    Command("stop", "Stop", ("K",), "Time"),
    Command("forward", "Play, faster each time", ("L",), "Time"),
    Command("previous", "Previous frame", ("Left",), "Time"),
    Command("next", "Next frame", ("Right",), "Time"),
    Command("back_ten", "Ten frames back", ("Shift+Left",), "Time"),
    Command("on_ten", "Ten frames on", ("Shift+Right",), "Time"),
    Command("previous_mark", "Previous click, pose edit or cut", ("Up",), "Time"),
    Command("next_mark", "Next click, pose edit or cut", ("Down",), "Time"),
    Command(
        "next_problem",
        "Next problem: where a click helps, the worst cut",
        ("N",),
        "Time",
    ),
    Command("previous_problem", "The problem before", ("Shift+N",), "Time"),
    Command("first", "First frame", ("Home",), "Time"),
    Command("last", "Last frame", ("End",), "Time"),
    Command("visited_back", "Frame visited before", ("Alt+Left",), "Time"),
    Command("visited_on", "Frame visited after", ("Alt+Right",), "Time"),
    Command("zoom_time_in", "Zoom into time", ("Ctrl+=", "Ctrl++"), "Time"),
    Command("zoom_time_out", "Zoom out of time", ("Ctrl+-",), "Time"),
    Command("fit_time", "Show the whole clip", ("Ctrl+0",), "Time"),
    Command("range_in", "Begin the range here", ("[",), "Time"),
    Command("range_out", "End the range here", ("]",), "Time"),
    Command("range_all", "Use the whole clip", ("\\",), "Time"),
    Command("video", "Video", ("F1",), "View"),
    Command("character", "Character", ("F2",), "View"),
    Command("performance", "Motion graph", ("F3",), "View"),
    Command("fit", "Show everything", ("F",), "View"),
    Command("magnifier", "Magnifier", ("Z",), "View"),
    Command("next_track", "Next point; Motion graph: the next control", ("Tab",), "View"),
    Command("next_part", "Motion graph: next part", ("F6",), "View"),
    Command("previous_part", "Motion graph: part before", ("Shift+F6",), "View"),
    Command("ghosts", "Ghosts of neighbouring frames", ("G",), "View"),
    Command("overlay", "Show or hide the marks", ("O",), "View"),
    Command("layer_paths", "Paths", ("Alt+1",), "View"),
    Command("layer_masks", "Masks", ("Alt+2",), "View"),
    Command("layer_onion", "Neighbouring masks", ("Alt+3",), "View"),
    Command("layer_names", "Names", ("Alt+4",), "View"),
    Command("layer_camera", "Points that the cameras were solved from", ("Alt+5",), "View"),
    Command("layer_grid", "Grid on the ground, horizon", ("Alt+6",), "View"),
    Command("layer_background", "Measured background: depth, confidence, clean plate", ("Alt+7",), "View"),
    Command("look_camera", "Look through the camera", ("1",), "View"),
    Command("look_side", "Look from the side", ("2",), "View"),
    Command("look_orbit", "Orbit", ("3",), "View"),
    Command("split", "Camera and side at once", ("D",), "View"),
    Command("before_after", "Before the edits, and after", ("A",), "View"),
    Command("heat", "Heat map: stretch, below the surface, none", ("Q",), "View"),
    Command("pair", "Pair points with vertices", ("W",), "Tools"),
    Command("gizmo_move", "Move the character in the first frame", ("T",), "Tools"),
    Command("gizmo_rotate", "Turn it", ("R",), "Tools"),
    Command("gizmo_scale", "Scale it", ("U",), "Tools"),
    Command("inspector", "Fold the column at the right away, or unfold it", ("I",), "View"),
    Command("history", "History", ("Ctrl+H",), "View"),
    Command("log", "Messages", ("Ctrl+L",), "View"),
    Command("light", "Light or dark", (), "View"),
    Command("keys", "Keys…", ("?",), "View"),
    Command("settings", "Settings…", ("Ctrl+,",), "View"),
    Command("tool_select", "Select", ("V",), "Tools"),
    Command("tool_lasso", "Lasso", ("M",), "Tools"),
    Command("tool_point", "Point", ("P",), "Tools"),
    Command("tool_contact", "Contact; once more: the chosen point in this frame", ("C",), "Tools"),
    Command("tool_ground", "Ground and scale", ("B",), "Tools"),
    Command("tool_pan", "Pan", ("H",), "Tools"),
)

BY_ID = {command.id: command for command in COMMANDS}
_DEFAULT = {key: command.id for command in COMMANDS for key in command.keys}
_own: dict[str, tuple[str, ...]] = {}


def keys_of(command_id: str) -> tuple[str, ...]:
    """The keys of a command as they are now."""
    return _own.get(command_id, BY_ID[command_id].keys)


def shown_key(command_id: str) -> str:
    """The key of a command as it is shown in a tooltip; empty where it has none."""
    keys = keys_of(command_id)
    return keys[0] if keys else ""


def present_key(key: str) -> str:
    """The key that now does what ``key`` came with, or that a command of this name has; others stay as they are."""
    command = key if key in BY_ID else _DEFAULT.get(key)
    return key if command is None else shown_key(command)


def holder(key: str) -> Command | None:
    """The command that a key belongs to now."""
    return next((command for command in COMMANDS if key in keys_of(command.id)), None)


def assign(command_id: str, keys: tuple[str, ...]) -> None:
    """Give a command other keys; whoever had them loses them."""
    for command in COMMANDS:
        left = tuple(key for key in keys_of(command.id) if key not in keys)
        if command.id != command_id and left != keys_of(command.id):
            _set(command.id, left)
    _set(command_id, tuple(dict.fromkeys(keys)))


def own_keys() -> dict[str, tuple[str, ...]]:
    """What differs from the keys that commands come with."""
    return dict(_own)


def set_own_keys(own: dict[str, tuple[str, ...]]) -> None:
    """Take what was remembered; commands that are no more are left out, and a key belongs to one command only."""
    _own.clear()
    for command_id, keys in own.items():
        if command_id in BY_ID:
            assign(command_id, keys)


def _set(command_id: str, keys: tuple[str, ...]) -> None:
    if keys == BY_ID[command_id].keys:
        _own.pop(command_id, None)
    else:
        _own[command_id] = keys
