/** Has the service worker keep what was loaded before it began, so that the first visit is enough. */
export class OfflineFiles {
  private readonly container = navigator.serviceWorker as ServiceWorkerContainer | undefined; // there in safe contexts alone
  /** The files of a page that a service worker answered are kept already, or are those of an older build. */
  private readonly first = !this.container?.controller;
  private waiting: string[] = [];
  private keeper: ServiceWorker | null = null;

  /** Keep files by their addresses, now or once there is who keeps them. */
  keep(addresses: string[]): void {
    if (!this.first) return;
    const loaded = addresses.filter((address) => address.startsWith("http"));
    if (this.keeper) this.keeper.postMessage(loaded);
    else this.waiting.push(...loaded);
  }

  /** Begin to keep: what has been loaded by then, and last the page itself, `worker` among its files. */
  async begin(service: string, worker: string): Promise<void> {
    if (!this.container) return;
    const registration = await this.container.register(service);
    await this.container.ready;
    this.keeper = registration.installing ?? registration.waiting ?? registration.active;
    const own = performance.getEntriesByType("resource").map(({ name }) => name);
    const page = new URL(location.href);
    page.hash = "";
    this.keep([...this.waiting.splice(0), ...own, new URL(worker, page).href, page.href]);
  }
}
