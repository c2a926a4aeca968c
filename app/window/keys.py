"""Every command of the window: what it is called, its keys, where it belongs. Keys stand here and nowhere else."""

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
    Command("save", "Save", ("Ctrl+S",)),
    Command("save_as", "Save as…", ("Ctrl+Shift+S",)),
    Command("add_clip", "Add a video…"),
    Command("add_character", "Add a character…"),
    Command("export", "Export…", ("Ctrl+E",)),
    Command("undo", "Undo", ("Ctrl+Z",), "Edit"),
    Command("redo", "Redo", ("Ctrl+Shift+Z", "Ctrl+Y"), "Edit"),
    Command("delete", "Delete what is selected", ("Delete",), "Edit"),
    Command("cancel", "Cancel the tool or the running work", ("Esc",), "Edit"),
    Command("propagate", "Run what is missing", ("Ctrl+Return",), "Edit"),
    Command("nudge_left", "Move the selected point left", ("Ctrl+Left",), "Edit"),
    Command("nudge_right", "Move the selected point right", ("Ctrl+Right",), "Edit"),
    Command("nudge_up", "Move the selected point up", ("Ctrl+Up",), "Edit"),
    Command("nudge_down", "Move the selected point down", ("Ctrl+Down",), "Edit"),
    Command("contact_here", "Contact of the selected point in this frame, or not", ("Shift+C",), "Edit"),
    Command("propose_contacts", "Propose contacts", ("Ctrl+Shift+C",), "Edit"),
    Command("accept_contacts", "Accept proposed contacts", ("Shift+Return",), "Edit"),
    Command("end_point", "End the selected point here", ("E",), "Edit"),
    Command("hide_point", "The selected point is hidden here, or not", ("X",), "Edit"),
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
    Command("previous_mark", "Previous click or pose edit", ("Up",), "Time"),
    Command("next_mark", "Next click or pose edit", ("Down",), "Time"),
    Command("next_problem", "Go where a click helps most", ("N",), "Time"),
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
    Command("fit", "Show everything", ("F",), "View"),
    Command("magnifier", "Magnifier", ("Z",), "View"),
    Command("next_track", "Next point", ("Tab",), "View"),
    Command("ghosts", "Ghosts of neighbouring frames", ("G",), "View"),
    Command("overlay", "Show or hide the marks", ("O",), "View"),
    Command("layer_paths", "Paths", ("Alt+1",), "View"),
    Command("layer_masks", "Masks", ("Alt+2",), "View"),
    Command("layer_onion", "Neighbouring masks", ("Alt+3",), "View"),
    Command("layer_names", "Names", ("Alt+4",), "View"),
    Command("layer_camera", "Points that the cameras were solved from", ("Alt+5",), "View"),
    Command("layer_grid", "Grid on the ground, horizon", ("Alt+6",), "View"),
    Command("look_camera", "Look through the camera", ("1",), "View"),
    Command("look_side", "Look from the side", ("2",), "View"),
    Command("look_orbit", "Orbit", ("3",), "View"),
    Command("history", "History", ("Ctrl+H",), "View"),
    Command("log", "Messages", ("Ctrl+L",), "View"),
    Command("light", "Light or dark", (), "View"),
    Command("keys", "Keys", ("?",), "View"),
    Command("tool_select", "Select", ("V",), "Tools"),
    Command("tool_lasso", "Lasso", ("M",), "Tools"),
    Command("tool_point", "Point", ("P",), "Tools"),
    Command("tool_contact", "Contact; once more: the chosen point in this frame", ("C",), "Tools"),
    Command("tool_ground", "Ground and scale", ("B",), "Tools"),
    Command("tool_pan", "Pan", ("H",), "Tools"),
)

BY_ID = {command.id: command for command in COMMANDS}


def shown_key(command_id: str) -> str:
    """The key of a command as it is shown in a tooltip; empty where it has none."""
    keys = BY_ID[command_id].keys
    return keys[0] if keys else ""
