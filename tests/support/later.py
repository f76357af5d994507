"""Long tests that a release has to pass, each with what looks at the same on every change.

`make test` leaves these out, as all that has the mark ``exhaustive``: they take long, and what
they show is shown by others too, less thoroughly or of fewer machines.  They were chosen by the
processor time of every test, of which each took more than a second, most of them three: of variants
of one test the longest, as long as one of each kind stays; a whole test only where another fails of
the same mistake.
"""

from __future__ import annotations

LATER: dict[str, dict[str, str]] = {
    "laws/test_advice.py": {
        "test_machines_of_other_trades[air-compressor]": "inline-3 and press, of the same test",
        "test_machines_of_other_trades[walking-beam]": "unit/balancing/test_advice.py asks for it",
    },
    "laws/test_jumping_rows.py": {
        "test_no_phases_of_a_fine_grid_are_better_than_those_that_are_chosen[peak]": "peak_to_peak",
    },
    "laws/test_phases.py": {
        "test_nothing_better_is_found_by_evolution[peak]": "squares, and force",
        "test_a_finer_grid_finds_the_same[5]": "4 rows, and fewer",
    },
    "laws/test_vibration_laws.py": {
        "test_energy_with_a_mount_that_lifts_off[free]": (
            "secondroute/test_vibration.py::test_steady_state[lifting off]"
        ),
    },
    "secondroute/test_planting.py": {
        "test_some_machines_plant_twice": "each of these machines, of this file's other tests",
    },
    "secondroute/test_vibration.py": {
        "test_steady_state[springs on two rows, free]": "motor on two rows",
        "test_steady_state[free, reversed]": "193 rpm, and lifting off",
        "test_steps_of_the_paper[54-reversed]": "57-reversed, and 54-one row",
        "test_steps_of_the_paper[59-reversed]": "57-reversed, and 59-one row",
        "test_steps_of_the_paper[57-one row]": "54-one row, and 57-reversed",
    },
    "surface/test_bad_input.py": {
        "test_huge_files_are_answered_soon[2 MB of loads]": "2 MB of comments, and the like",
        "test_huge_files_are_answered_soon[2000 links in four-bars]": "100 links in four-bars",
        "test_interruption_of_what_takes_long[words0]": "words1",
    },
    "surface/test_balance.py": {
        "test_outputs_of_several_rows_are_taken_by_the_names_that_results_have[drive_torque]": (
            "rows.drive_torque"
        ),
        "test_a_range_of_ratios_is_proved_one_by_one": (
            "unit/balancing/test_gear_search.py::test_two_shafts_with_choices_each"
        ),
    },
    "surface/test_commands.py": {
        "test_a_current_folder_that_was_deleted[export yamashita-1 -o x.urdf]": "report",
        "test_a_current_folder_that_was_deleted[mcp]": "report",
        "test_output_in_a_terminal_that_lacks_letters[cp1252]": "ascii",
        "test_help_where_the_size_of_the_terminal_is_no_size[COLUMNS-\\xb2]": "COLUMNS-size1",
    },
    "surface/test_hostile_numbers.py": {
        "test_what_broke_once_is_refused[0-path0-1e30 N m-cannot be integrated beyond]": (
            "the others that broke once"
        ),
    },
    "surface/test_interrupted.py": {
        "test_an_interrupt_while_direction_numbers_are_loaded[tolerance-study1]": "search",
    },
    "surface/test_links.py": {
        "test_a_page_saves_through_no_link_that_was_put_in_the_place_of_its_file"
        "[linkage-put_elsewhere]": "tool-put_beside, and linkage-put_above",
        "test_what_is_written_goes_through_no_link_that_comes_meanwhile[plant fit --csv-file]": (
            "--csv-folder"
        ),
        "test_what_is_written_goes_through_no_link_that_comes_meanwhile[report-folder]": "file",
        "test_what_is_written_goes_through_no_link_that_leads_out[plant fit --csv-nowhere]": (
            "secret.txt, and nowhere of the other commands"
        ),
        "test_no_kind_of_file_is_written_through_a_link[out.pdf1]": "out.pdf0",
    },
    "surface/test_respond.py": {
        "test_both_branches_of_a_range": "test_the_louder_of_two_steady_states, at two speeds",
        "test_rows_in_opposite_phase_on_a_float": "secondroute/test_vibration.py, two rows",
    },
    "surface/test_supports.py": {
        "test_any_linkage_on_a_support[geared-counterweight]": "planetary-planting-arm, geared too",
    },
    "unit/balancing/test_beyond_masses.py": {
        "test_a_flywheel_on_a_faster_shaft_names_what_is_assumed": (
            "surface/test_balance.py: the flywheel of plunger-pump stands on the first page"
        ),
    },
    "unit/balancing/test_gear_search.py": {
        "test_two_shafts_with_ranges": "test_two_shafts_with_choices_each, and test_geared.py",
    },
    "unit/design/test_a_new_solver.py": {
        "test_balance_chooses_gears_by_it": "test_the_page_balances_by_it, of the same machine",
    },
    "unit/design/test_evaluator.py": {
        "test_a_search_of_geometry_is_the_same_with_any_number_of_workers": (
            "test_a_search_is_the_same_with_any_number_of_workers, by the same processes"
        ),
    },
    "unit/figures/test_pictures.py": {
        "test_charts_of_odd_machines[tools: crowded]": "vibration: crowded, and tools: odd names",
        "test_charts_of_odd_machines[vibration: odd names]": "tools: odd names",
    },
    "unit/handheld/test_tool_design.py": {
        "test_nothing_better_by_chance[masses]": "absorber",
    },
    "unit/planting/test_search.py": {
        "test_arms_on_gears_are_found_again": "test_shaking_is_kept_small, of the same arms",
    },
    "unit/present/test_same_numbers.py": {
        "test_every_number_of_tables_is_in_the_json[riding-transplanter]": "sieve, yamashita-rig",
    },
    "unit/results/test_headline.py": {
        f"test_what_stands_first_has_fifteen_lines_and_begins_with_the_verdict[balance {name}]": (
            "laws/test_advice.py computes it, and others here are laid out"
        )
        for name in (
            "air-compressor",
            "grain-cleaner",
            "reciprocating-saw",
            "sieve-on-stand",
            "walking-transplanter",
            "wiper",
        )
    }
    | {"test_a_command_prints_a_few_lines_and_the_rest_with_full[command2]": "the other commands"},
    "unit/studies/test_objective_map.py": {
        "test_many_machines_at_once_are_those_one_by_one[quick-return-drive_torque-area]": (
            "yamashita-1, and contacts that change sides"
        ),
        "test_contacts_that_change_sides_are_those_of_each_machine[joints.D]": "racks and belts",
    },
    "unit/studies/test_run.py": {
        "test_killed_processes_leave_a_store_that_ends_with_the_same_bytes": (
            "test_the_end_may_come_at_any_file_of_a_chunk, and surface/test_sweep.py"
        ),
    },
    "unit/web/test_interactive.py": {
        f"test_signs_follow_the_numbers[{name}]": "half of the machines"
        for name in ("slider-crank-engine", "watt-six-bar")
    },
    "unit/web/test_sketch.py": {
        f"test_whatever_names_a_point_or_a_link_gets_its_new_name[{name}]": "hydraulic-loader"
        for name in ("cam-pusher", "riding-transplanter")
    },
}
"""By file: a test, or one of its variants, and what says on every change that its subject broke."""
