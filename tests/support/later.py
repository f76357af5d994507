"""Long tests that a release has to pass, of which others look at the same on every change.

`make test` leaves these out, as all that has the mark ``exhaustive``: they take long, and what
they show is shown by others too, less thoroughly or of fewer machines.  They were chosen by the
processor time of every test.
"""

from __future__ import annotations

VARIANTS: dict[str, dict[str, tuple[str, ...]]] = {
    "browser/test_hostile.py": {
        "test_a_link_that_holds_no_model_is_refused_in_a_sentence": (
            "socket-not UTF-8",
            "socket-cut off",
            "socket-tables that are no JSON",
        ),
        "test_tables_of_other_kinds_are_refused_in_a_sentence": (
            "socket-tables1",
            "socket-tables2",
        ),
    },
    "browser/test_interactive.py": {
        "test_it_fits_every_width": ("planetary-planting-arm-Q",),
    },
    "browser/test_looks.py": {
        "test_the_menu_of_downloads_is_seen_whole": (
            "socket-600-900",
            "socket-400-900",
        ),
        "test_a_report": ("socket-kim-chung-c",),
        "test_reports_are_short_and_fit": ("socket-hydraulic-loader",),
    },
    "browser/test_site.py": {
        "test_the_first_hit_answers": (
            "how to cure a change point",
            "how to put a machine on mounts",
            "torsion spring table",
            "about which point is a shaking moment taken",
        ),
    },
    "browser/test_stage.py": {
        "test_sentences_that_come_and_go_leave_the_sheet_where_it_is": (
            "socket-400-en",
            "socket-400-ko",
            "socket-1280-ja",
            "socket-1280-ko",
        ),
    },
    "laws/test_advice.py": {
        "test_machines_of_other_trades": (
            "air-compressor",
            "walking-beam",
        ),
    },
    "laws/test_jumping_rows.py": {
        "test_no_phases_of_a_fine_grid_are_better_than_those_that_are_chosen": ("peak",),
    },
    "laws/test_phases.py": {
        "test_nothing_better_is_found_by_evolution": ("peak",),
        "test_a_finer_grid_finds_the_same": ("5",),
        "test_polished_to_ten_digits": ("size",),
        "test_no_phases_of_bundled_machines_are_better_on_a_grid": ("riding-transplanter",),
    },
    "laws/test_planting_laws.py": {
        "test_mirror_image": (
            "kim-chung-a-backward",
            "kim-chung-b-forward",
            "kim-chung-c-backward",
        ),
        "test_time_reversed": (
            "kim-chung-b-forward",
            "kim-chung-c-forward",
        ),
    },
    "laws/test_run.py": {
        "test_a_pendulum_swings_as_it_has_to": ("0.1",),
    },
    "laws/test_run_friction.py": {
        "test_a_coast_down_loses_its_energy_in_joints": ("machine1",),
    },
    "laws/test_scaling.py": {
        "test_every_objective": ("yamashita-1-peak",),
    },
    "laws/test_vibration_laws.py": {
        "test_energy_with_a_mount_that_lifts_off": ("free",),
    },
    "secondroute/test_codegen.py": {
        "test_cams": (
            "pusher_tappet-0",
            "fixed_cam_lever-0",
            "camshaft_lever-0",
        ),
    },
    "secondroute/test_proved.py": {
        "test_no_phases_are_better_than_what_is_proved": ("5",),
    },
    "secondroute/test_vibration.py": {
        "test_steady_state": (
            "springs on two rows, free",
            "free, reversed",
        ),
        "test_steps_of_the_paper": (
            "54-reversed",
            "59-reversed",
            "57-one row",
        ),
    },
    "surface/test_bad_input.py": {
        "test_huge_files_are_answered_soon": (
            "2 MB of loads",
            "2000 links in four-bars",
        ),
        "test_interruption_of_what_takes_long": ("words0",),
    },
    "surface/test_balance.py": {
        "test_outputs_of_several_rows_are_taken_by_the_names_that_results_have": ("drive_torque",),
        "test_the_new_model_does_what_was_printed": (
            "exudyn-slider-crank",
            "balance-coupler",
        ),
    },
    "surface/test_commands.py": {
        "test_a_current_folder_that_was_deleted": (
            "export yamashita-1 -o x.urdf",
            "mcp",
        ),
        "test_output_in_a_terminal_that_lacks_letters": ("cp1252",),
        "test_help_where_the_size_of_the_terminal_is_no_size": ("COLUMNS-\\xb2",),
    },
    "surface/test_hostile_numbers.py": {
        "test_what_broke_once_is_refused": ("0-path0-1e30 N m-cannot be integrated beyond",),
    },
    "surface/test_interrupted.py": {
        "test_an_interrupt_while_direction_numbers_are_loaded": ("tolerance-study1",),
    },
    "surface/test_links.py": {
        "test_a_page_saves_through_no_link_that_was_put_in_the_place_of_its_file": (
            "linkage-put_elsewhere",
        ),
        "test_what_is_written_goes_through_no_link_that_comes_meanwhile": (
            "plant fit --csv-file",
            "report-folder",
        ),
        "test_what_is_written_goes_through_no_link_that_leads_out": ("plant fit --csv-nowhere",),
        "test_no_kind_of_file_is_written_through_a_link": ("out.pdf1",),
    },
    "surface/test_supports.py": {
        "test_any_linkage_on_a_support": ("geared-counterweight",),
    },
    "surface/test_tool.py": {
        "test_every_bundled_tool_is_told": ("brush-cutter",),
    },
    "surface/test_units.py": {
        "test_a_pump_jack_is_told_in_numbers_that_can_be_read": (
            "simulate 2 s",
            "respond --speed 5 rpm : 40 rpm --speeds 5 --full",
        ),
    },
    "unit/balancing/test_beyond_masses.py": {
        "test_every_answer_is_in_the_machine_readable_output": ("rotary-transplanter-arms",),
    },
    "unit/codegen/test_batch.py": {
        "test_designs_about_the_border": ("stephenson",),
        "test_four_bars_about_the_border": ("-6",),
        "test_dyad_on_a_fast_gear": ("12.0",),
        "test_order_and_splitting_change_no_bit": ("60",),
        "test_threads_change_no_bit": ("360",),
        "test_loads_that_end_in_a_step": (
            "0.5",
            "1.0",
        ),
    },
    "unit/design/test_evaluator.py": {
        "test_no_figure_of_a_finger_depends_on_those_computed_beside_it": ("transplanter",),
        "test_what_arrays_compute_is_sent_in_large_parts": ("100-sizes0",),
    },
    "unit/exchange/test_drawings.py": {
        "test_a_workshop_drawing_gives_what_was_advised": ("yamashita-rig",),
    },
    "unit/figures/test_legible.py": {
        "test_no_label_of_a_mode_covers_another": ("ko",),
    },
    "unit/figures/test_pictures.py": {
        "test_charts_of_odd_machines": (
            "tools: crowded",
            "vibration: odd names",
        ),
    },
    "unit/figures/test_vibration_charts.py": {
        "test_bands_to_keep_away_from": ("-1",),
    },
    "unit/handheld/test_chain.py": {
        "test_count_is_that_of_negative_eigenvalues": (
            "euler-bernoulli-1",
            "timoshenko-1",
        ),
    },
    "unit/handheld/test_tool_design.py": {
        "test_nothing_better_by_chance": ("masses",),
        "test_limits_matter": ("masses",),
    },
    "unit/mechanism/test_redundant.py": {
        "test_of_all_kinds_both_rules_tell_alike_what_statics_decides": ("planet_differential",),
    },
    "unit/planting/test_arms.py": {
        "test_an_arm_that_only_starts_elsewhere_is_told_its_start": ("10.0",),
    },
    "unit/planting/test_figures.py": {
        "test_a_stack_of_designs_has_the_figures_of_each": ("kim-chung-a",),
    },
    "unit/present/test_findings.py": {
        "test_pictures_have_a_place_a_caption_and_a_name_of_their_own": ("transplanter-some2",),
    },
    "unit/present/test_headlines.py": {
        "test_pages_end_alike_whatever_fonts_a_computer_has": ("yamashita-rig",),
        "test_eastern_letters_are_of_a_font_that_has_them": ("ko",),
        "test_the_pdf_is_short": ("drag-link-7",),
        "test_names_of_the_file_are_told_from_words": ("ko",),
    },
    "unit/present/test_same_numbers.py": {
        "test_every_number_of_tables_is_in_the_json": ("riding-transplanter",),
        "test_what_balance_makes_small_is_what_analyze_says": ("riding-transplanter",),
    },
    "unit/results/test_headline.py": {
        "test_what_stands_first_has_fifteen_lines_and_begins_with_the_verdict": (
            "balance air-compressor",
            "balance grain-cleaner",
            "balance reciprocating-saw",
            "balance sieve-on-stand",
            "balance walking-transplanter",
            "balance wiper",
        ),
        "test_a_command_prints_a_few_lines_and_the_rest_with_full": ("command2",),
        "test_the_verdict_of_this_machine_stands_first_everywhere": (
            "quick-return-Drive torque, peak to peak: 211 N m",
            "twin-engine-Rocking moment, peak: 116 N m",
        ),
    },
    "unit/studies/test_evaluate.py": {
        "test_planting_figures_of_many_designs_are_those_of_each": ("transplanter",),
    },
    "unit/studies/test_objective_map.py": {
        "test_many_machines_at_once_are_those_one_by_one": ("quick-return-drive_torque-area",),
        "test_contacts_that_change_sides_are_those_of_each_machine": ("joints.D",),
    },
    "unit/vibration/test_forced.py": {
        "test_a_speed_within_a_resonance_says_so": ("118.5",),
    },
    "unit/vibration/test_sampling.py": {
        "test_curves_between_speeds_are_where_they_are_drawn": ("sieve",),
        "test_speed_of_the_machine_is_one_of_them": ("walking-transplanter",),
    },
    "unit/vibration/test_transient.py": {
        "test_a_motor_that_stalls": (
            "simulate-held--1",
            "respond-free--1",
            "respond-held--1",
        ),
        "test_it_dies_out_into_the_steady_state": ("-20.210912738094336",),
    },
    "unit/web/test_gallery.py": {
        "test_every_machine_is_offered_with_a_picture_and_a_sentence": ("ko",),
    },
    "unit/web/test_interactive.py": {
        "test_signs_follow_the_numbers": (
            "slider-crank-engine",
            "watt-six-bar",
        ),
    },
    "unit/web/test_sketch.py": {
        "test_whatever_names_a_point_or_a_link_gets_its_new_name": (
            "cam-pusher",
            "riding-transplanter",
            "balance-spring",
        ),
    },
    "unit/web/test_words.py": {
        "test_what_a_page_is_told_is_in_its_language": ("riding-transplanter",),
    },
}
"""By file and test: the longest variants, of which others of their kind stay."""
WHOLE: dict[str, dict[str, str]] = {
    "secondroute/test_planting.py": {
        "test_some_machines_plant_twice": "each of these machines, of this file's other tests",
    },
    "surface/test_balance.py": {
        "test_a_range_of_ratios_is_proved_one_by_one": (
            "unit/balancing/test_gear_search.py::test_two_shafts_with_choices_each"
        ),
    },
    "surface/test_respond.py": {
        "test_both_branches_of_a_range": "test_the_louder_of_two_steady_states, at two speeds",
        "test_rows_in_opposite_phase_on_a_float": "secondroute/test_vibration.py, two rows",
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
    "unit/planting/test_search.py": {
        "test_arms_on_gears_are_found_again": "test_shaking_is_kept_small, of the same arms",
    },
    "unit/studies/test_run.py": {
        "test_killed_processes_leave_a_store_that_ends_with_the_same_bytes": (
            "test_the_end_may_come_at_any_file_of_a_chunk, and surface/test_sweep.py"
        ),
    },
}
"""By file: a test, and what fails of the same mistake on every change."""


def later(file: str) -> frozenset[str]:
    """Names of the tests of a file, by its path below `tests`, that only a release has to pass."""
    variants = VARIANTS.get(file, {}).items()
    named = (f"{test}[{name}]" for test, names in variants for name in names)
    return frozenset((*WHOLE.get(file, ()), *named))
